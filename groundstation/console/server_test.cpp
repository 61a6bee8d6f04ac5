// SPDX-License-Identifier: Apache-2.0
#include "skein/console/server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <semaphore>
#include <thread>

#include "login_waits.hpp"
#include "machine_pages.hpp"

namespace skein::console {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using beast::error_code;
using Json = nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A server, and a ground station that answers every line with itself.
class Station {
 public:
  explicit Station(ServerConfig config = {}) {
    config.port = 0;
    auto opened = Server::open(std::move(config), [this] { requests_.release(); });
    EXPECT_TRUE(opened.ok()) << (opened.ok() ? "" : opened.error().message);
    server_ = std::move(*opened);
    const std::string url = server_->url();
    const auto colon = url.rfind(':');
    port_ = static_cast<std::uint16_t>(std::stoi(url.substr(colon + 1)));
    answering_ = std::thread{[this] { answer(); }};
  }
  ~Station() {
    ending_ = true;
    requests_.release();
    answering_.join();
  }
  Station(const Station&) = delete;
  Station& operator=(const Station&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] std::string host() const { return "127.0.0.1:" + std::to_string(port_); }
  Server& server() { return *server_; }

 private:
  void answer() {
    while (!ending_) {
      requests_.acquire();
      while (const auto request = server_->next()) {
        if (const auto* line = std::get_if<Server::Line>(&*request)) {
          line->reply(line->may_order, line->user + ": " + line->line, line->order);
        } else {
          std::get<Server::Join>(*request).reply("[]");
        }
      }
    }
  }

  std::counting_semaphore<> requests_{0};
  std::atomic<bool> ending_{false};
  std::unique_ptr<Server> server_;
  std::uint16_t port_ = 0;
  std::thread answering_;
};

http::response<http::string_body> ask(const Station& station,
                                      http::request<http::string_body> request) {
  asio::io_context context;
  beast::tcp_stream stream{context};
  stream.connect(tcp::endpoint{asio::ip::make_address("127.0.0.1"), station.port()});
  if (request.find(http::field::host) == request.end()) {
    request.set(http::field::host, station.host());
  }
  request.prepare_payload();
  http::write(stream, request);
  beast::flat_buffer buffer;
  http::response<http::string_body> response;
  error_code error;
  http::read(stream, buffer, response, error);
  EXPECT_FALSE(error) << error.message();
  return response;
}

http::request<http::string_body> get(const std::string& path) {
  return {http::verb::get, path, 11};
}

http::request<http::string_body> login(const std::string& user, const std::string& password) {
  http::request<http::string_body> request{http::verb::post, "/session", 11};
  request.body() = Json{{"user", user}, {"password", password}}.dump();
  return request;
}

/// The socket, as the page opens it or otherwise.
class Page {
 public:
  struct How {
    std::string origin = {};
    std::string host = {};
    std::string protocol = "skein.console.1";
    std::string cookie = {};
    std::string path = "/socket";
  };
  Page(const Station& station, const How& how) {
    beast::get_lowest_layer(socket_).connect(
        tcp::endpoint{asio::ip::make_address("127.0.0.1"), station.port()});
    socket_.set_option(websocket::stream_base::decorator([how](websocket::request_type& request) {
      if (!how.origin.empty()) request.set(http::field::origin, how.origin);
      if (!how.cookie.empty()) request.set(http::field::cookie, how.cookie);
      if (!how.protocol.empty()) request.set(http::field::sec_websocket_protocol, how.protocol);
    }));
    socket_.handshake(how.host.empty() ? station.host() : how.host, how.path, error_);
  }
  explicit Page(const Station& station) : Page{station, How{}} {}

  [[nodiscard]] bool open() const { return !error_; }
  void say(const std::string& text) { socket_.write(asio::buffer(text), error_); }
  void resume() { say(R"({"type":"resume","next_seq":0})"); }
  /// Empty when the connection has ended.
  std::string read() {
    beast::flat_buffer buffer;
    socket_.read(buffer, error_);
    return error_ ? "" : beast::buffers_to_string(buffer.data());
  }
  /// The next text of that type; null when the connection has ended.
  Json read(const std::string& type) {
    for (std::string text = read(); !text.empty(); text = read()) {
      Json json = Json::parse(text);
      if (json["type"] == type) return json;
    }
    return {};
  }
  [[nodiscard]] websocket::close_code why() const {
    return static_cast<websocket::close_code>(socket_.reason().code);
  }

 private:
  asio::io_context context_;
  websocket::stream<beast::tcp_stream> socket_{context_};
  error_code error_;
};

ServerConfig with_users() {
  ServerConfig config;
  config.log_in =
      [users = *Users::parse("ada:operator:" + hash_password("difference", "5a17", 1000) +
                                 "\nbob:observer:" + hash_password("lookonly", "5a18", 1000) + "\n",
                             "passwords")](const std::string& user, std::string_view password) {
        return users.check(user, password);
      };
  return config;
}

TEST(Server, GivesThePageAndItsFields) {
  const Station station;
  const auto page = ask(station, get("/"));
  EXPECT_EQ(page.result(), http::status::ok);
  EXPECT_EQ(page[http::field::content_encoding], "gzip");
  EXPECT_THAT(std::string{page["Content-Security-Policy"]}, HasSubstr("default-src 'self'"));
  EXPECT_EQ(page["X-Content-Type-Options"], "nosniff");
  EXPECT_EQ(ask(station, get("/assets/../server.cpp")).result(), http::status::not_found);
  EXPECT_EQ(Json::parse(ask(station, get("/session")).body())["role"], "operator");
  http::request<http::string_body> put{http::verb::put, "/", 11};
  EXPECT_EQ(ask(station, put).result(), http::status::method_not_allowed);
}

TEST(Server, OfAHeadTheLengthOnly) {
  const Station station;
  asio::io_context context;
  beast::tcp_stream stream{context};
  stream.connect(tcp::endpoint{asio::ip::make_address("127.0.0.1"), station.port()});
  beast::flat_buffer buffer;
  const auto answer_to = [&](http::verb verb) {
    http::request<http::string_body> request{verb, "/", 11};
    request.set(http::field::host, station.host());
    http::write(stream, request);
    http::response_parser<http::string_body> parser;
    parser.skip(verb == http::verb::head);
    http::read(stream, buffer, parser);
    return parser.release();
  };
  const auto head = answer_to(http::verb::head);
  const auto page = answer_to(http::verb::get);  // on the same connection
  EXPECT_EQ(page.result(), http::status::ok);
  EXPECT_EQ(head[http::field::content_length], std::to_string(page.body().size()));
}

TEST(Server, SaysHelloThenHistoryThenEventsAndStates) {
  Station station;
  std::vector<std::string> events;
  for (int i = 0; i < 450; ++i) events.push_back(R"({"seq":)" + std::to_string(i) + "}");
  station.server().append(events);
  Page page{station};
  ASSERT_TRUE(page.open());
  EXPECT_EQ(Json::parse(page.read())["type"], "hello");
  page.resume();
  EXPECT_EQ(Json::parse(page.read())["events"]["next_seq"], 450);
  int next = 0;
  while (next < 450) {
    const Json text = page.read("events");
    ASSERT_TRUE(page.open());
    for (const Json& event : text["events"]) EXPECT_EQ(event["seq"], next++);
  }
  Sections sections;
  sections[0] = "[1]";
  sections[1] = "[2]";
  station.server().publish(1.0, sections);
  const Json first = page.read("state");
  EXPECT_EQ(first["vehicles"], Json::parse("[1]"));
  EXPECT_EQ(first["plans"], Json::parse("[2]"));
  sections[0] = "[3]";
  station.server().publish(2.0, sections);
  const Json second = page.read("state");
  EXPECT_EQ(second["vehicles"], Json::parse("[3]"));
  EXPECT_FALSE(second.contains("plans"));  // has not changed
  EXPECT_EQ(second["time_s"], 2.0);
}

TEST(Server, AReplayThatJumpsBackSendsTheEventsAnew) {
  Station station;
  station.server().append({R"({"seq":0})", R"({"seq":1})", R"({"seq":2})"});
  Page page{station};
  page.resume();
  EXPECT_EQ(page.read("events")["events"].size(), 3U);
  station.server().restart(1, "[7]");
  const Json history = page.read("history");
  EXPECT_EQ(history["series"], Json::parse("[7]"));
  EXPECT_EQ(history["events"]["next_seq"], 1);
  station.server().append({R"({"seq":1})"});
  EXPECT_EQ(page.read("events")["events"][0]["seq"], 1);
}

TEST(Server, ItsLastWordsComeAfterTheNewestOfEverything) {
  auto station = std::make_unique<Station>();
  Page page{*station};
  page.resume();
  EXPECT_FALSE(page.read("history").is_null());
  station->server().append({R"({"seq":0})"});
  Sections sections;
  sections[0] = "[1]";
  station->server().publish(45.0, sections);
  station->server().end(45.0, "1 of 1 sites done\n");
  station.reset();
  EXPECT_EQ(Json::parse(page.read())["type"], "events");
  EXPECT_EQ(Json::parse(page.read())["vehicles"], Json::parse("[1]"));
  const Json last = Json::parse(page.read());
  EXPECT_EQ(last["type"], "ended");
  EXPECT_EQ(last["time_s"], 45.0);
  EXPECT_EQ(last["text"], "1 of 1 sites done\n");
  EXPECT_EQ(page.read(), "");
}

TEST(Server, PassesLinesOnAndAnswers) {
  const Station station;
  Page page{station};
  page.say(R"({"type":"line","id":2,"line":"hold all"})");
  EXPECT_EQ(page.read("answer")["data"], nullptr);
  page.say(R"({"type":"order","id":3,"order":{"kind":"decision","round":4}})");
  const Json answer = page.read("answer");
  EXPECT_EQ(answer["id"], 3);
  EXPECT_EQ(answer["done"], true);
  EXPECT_EQ(answer["text"], "operator: ");
  EXPECT_EQ(answer["data"]["round"], 4);
  page.say(R"({"type":"ping","id":4})");
  EXPECT_EQ(page.read("pong")["id"], 4);
}

TEST(Server, IsForItsOwnPageOnly) {
  const Station station;
  const auto opens = [&](const Page::How& how) { return Page{station, how}.open(); };
  EXPECT_TRUE(opens({}));  // another program, no browser
  EXPECT_TRUE(opens({.origin = "http://" + station.host()}));
  EXPECT_TRUE(opens({.origin = "http://localhost:1", .host = "localhost:1"}));
  EXPECT_FALSE(opens({.origin = "http://evil.example"}));
  EXPECT_FALSE(opens({.origin = "https://" + station.host()}));
  EXPECT_FALSE(opens({.origin = "null"}));
  // A name that somebody points to 127.0.0.1.
  EXPECT_FALSE(opens({.origin = "http://evil.example", .host = "evil.example"}));
  EXPECT_FALSE(opens({.host = "evil.example"}));
  EXPECT_FALSE(opens({.protocol = ""}));
  EXPECT_FALSE(opens({.protocol = "skein.console.2"}));
  EXPECT_FALSE(opens({.path = "/other"}));
}

TEST(Server, EndsWithWhoTalksNonsense) {
  const Station station;
  for (const char* nonsense :
       {"", "{", "[]", "null", R"({"type":7})", R"({"type":"order","id":1})",
        R"({"type":"line","id":1})", R"({"type":"line","id":"x","line":"status"})",
        R"({"type":"resume","next_seq":-1})", R"({"type":"order","id":1,"order":"hold all"})",
        "\xff\xfe"}) {
    Page page{station};
    page.say(nonsense);
    while (!page.read().empty()) {
    }
    EXPECT_FALSE(page.open()) << nonsense;
  }
  Page page{station};
  page.say(std::string(5000, ' '));
  while (!page.read().empty()) {
  }
  EXPECT_EQ(page.why(), websocket::close_code::too_big);
  EXPECT_TRUE(Page{station}.open());  // the others do not notice
}

TEST(Server, EndsWithWhoFloods) {
  const Station station;
  Page calm{station};
  Page flood{station};
  for (int i = 0; i < 200 && flood.open(); ++i) flood.say(R"({"type":"ping","id":1})");
  while (!flood.read().empty()) {
  }
  EXPECT_FALSE(flood.open());
  calm.say(R"({"type":"ping","id":9})");
  EXPECT_EQ(calm.read("pong")["id"], 9);
}

TEST(Server, TakesNoMoreThanItsConnections) {
  const Station station;
  std::vector<std::unique_ptr<Page>> pages;
  for (int i = 0; i < 80; ++i) {
    pages.push_back(std::make_unique<Page>(station));
    if (!pages.back()->open()) break;
  }
  EXPECT_EQ(pages.size(), 65U);
}

TEST(Server, LetsInWhoKnowsThePassword) {
  ServerConfig config = with_users();
  std::mutex mutex;
  std::vector<std::string> keys;
  config.on_logout = [&](const std::string& user) {
    const std::lock_guard lock{mutex};
    keys.push_back(user + " locks");
  };
  const Station station{std::move(config)};
  EXPECT_EQ(ask(station, get("/")).result(), http::status::ok);  // the page, which asks for it
  EXPECT_EQ(ask(station, get("/session")).result(), http::status::unauthorized);
  EXPECT_FALSE(Page{station}.open());
  for (const auto& [user, password] :
       {std::pair{"ada", "wrong"}, {"eve", "difference"}, {"", ""}}) {
    EXPECT_EQ(ask(station, login(user, password)).result(), http::status::unauthorized);
  }
  const auto let_in = ask(station, login("ada", "difference"));
  ASSERT_EQ(let_in.result(), http::status::ok);
  const std::string field{let_in[http::field::set_cookie]};
  EXPECT_THAT(field, HasSubstr("HttpOnly; SameSite=Strict"));
  const std::string cookie = field.substr(0, field.find(';'));
  auto who = get("/session");
  who.set(http::field::cookie, "other=1; " + cookie);
  EXPECT_EQ(Json::parse(ask(station, who).body())["user"], "ada");
  EXPECT_TRUE((Page{station, {.cookie = cookie}}.open()));
  EXPECT_FALSE((Page{station, {.cookie = cookie + "0"}}.open()));
  Page open{station, {.cookie = cookie}};
  ASSERT_TRUE(open.open());
  http::request<http::string_body> out{http::verb::delete_, "/session", 11};
  out.set(http::field::cookie, cookie);
  EXPECT_EQ(ask(station, out).result(), http::status::ok);
  EXPECT_FALSE((Page{station, {.cookie = cookie}}.open()));
  while (!open.read().empty()) {
  }
  EXPECT_FALSE(open.open()) << "what is open by a session ends with it";
  const std::lock_guard lock{mutex};
  EXPECT_THAT(keys, ElementsAre("ada locks"));
}

TEST(Server, WhoIsExpelledIsOutAtOnce) {
  Station station{with_users()};
  const auto cookie_of = [&station](const char* user, const char* password) {
    const std::string field{ask(station, login(user, password))[http::field::set_cookie]};
    return field.substr(0, field.find(';'));
  };
  const std::string ada = cookie_of("ada", "difference");
  const std::string ada_elsewhere = cookie_of("ada", "difference");
  const std::string bob = cookie_of("bob", "lookonly");
  Page open{station, {.cookie = ada}};
  ASSERT_TRUE(open.open());
  station.server().expel("ada");
  while (!open.read().empty()) {
  }
  EXPECT_FALSE(open.open());
  EXPECT_FALSE((Page{station, {.cookie = ada_elsewhere}}.open()));
  EXPECT_TRUE((Page{station, {.cookie = bob}}.open()));
}

TEST(Server, WithATokenLetsInWhoHasIt) {
  ServerConfig config;
  config.token = "0123456789abcdef0123456789abcdef";
  const Station station{std::move(config)};
  const auto refused = ask(station, get("/session"));
  EXPECT_EQ(refused.result(), http::status::unauthorized);
  EXPECT_EQ(Json::parse(refused.body())["asks"], "token");
  EXPECT_FALSE(Page{station}.open());
  for (int i = 0; i < 20; ++i) {  // nobody on this machine makes the operator wait
    EXPECT_EQ(ask(station, login("", "0123456789abcdef0123456789abcdee")).result(),
              http::status::unauthorized);
  }
  for (const char* wrong : {"", "0123", "0123456789abcdef0123456789abcdef0"}) {
    EXPECT_EQ(ask(station, login("operator", wrong)).result(), http::status::unauthorized) << wrong;
  }
  const auto let_in = ask(station, login("", "0123456789abcdef0123456789abcdef"));
  ASSERT_EQ(let_in.result(), http::status::ok);
  const std::string field{let_in[http::field::set_cookie]};
  EXPECT_TRUE((Page{station, {.cookie = field.substr(0, field.find(';'))}}.open()));
}

TEST(Server, WithTheObserversTokenOneLooksOnly) {
  ServerConfig config;
  config.token = "0123456789abcdef0123456789abcdef";
  config.observer_token = "fedcba9876543210fedcba9876543210";
  const Station station{std::move(config)};
  const auto let_in = ask(station, login("operator", "fedcba9876543210fedcba9876543210"));
  ASSERT_EQ(let_in.result(), http::status::ok);
  EXPECT_EQ(Json::parse(let_in.body())["role"], "observer");
  EXPECT_EQ(Json::parse(ask(station, login("", "0123456789abcdef0123456789abcdef")).body())["role"],
            "operator");
}

TEST(Server, WhoGuessesPasswordsWaitsAndIsTold) {
  ServerConfig config = with_users();
  std::mutex mutex;
  std::vector<RefusedLogin> refused;
  config.on_refused_login = [&](const RefusedLogin& one) {
    const std::lock_guard lock{mutex};
    refused.push_back(one);
  };
  const Station station{std::move(config)};
  for (int i = 0; i <= LoginWaits::kFree; ++i) {
    EXPECT_EQ(ask(station, login("ada\n", "guess")).result(), http::status::unauthorized);
  }
  const auto waits = ask(station, login("ada", "difference"));
  EXPECT_EQ(waits.result(), http::status::too_many_requests);
  EXPECT_THAT(waits.body(), HasSubstr("try again in 1 s"));
  const std::lock_guard lock{mutex};
  ASSERT_EQ(refused.size(), LoginWaits::kFree + 1U);
  EXPECT_EQ(refused.back().user, "ada ");
  EXPECT_EQ(refused.back().address, "127.0.0.1");
  EXPECT_EQ(refused.back().in_a_row, LoginWaits::kFree + 1);
  EXPECT_EQ(refused.back().wait, std::chrono::seconds{1});
}

TEST(Server, WhoOnlyConnectsKeepsNobodyOut) {
  const Station station{with_users()};
  asio::io_context context;
  std::vector<std::unique_ptr<beast::tcp_stream>> idle;
  for (int i = 0; i < 80; ++i) {
    idle.push_back(std::make_unique<beast::tcp_stream>(context));
    idle.back()->connect(tcp::endpoint{asio::ip::make_address("127.0.0.1"), station.port()});
  }
  EXPECT_EQ(ask(station, login("ada", "difference")).result(), http::status::ok);
}

TEST(Server, AnObserverIsKnownAsOne) {
  const Station station{with_users()};
  const auto let_in = ask(station, login("bob", "lookonly"));
  const std::string field{let_in[http::field::set_cookie]};
  Page page{station, {.cookie = field.substr(0, field.find(';'))}};
  EXPECT_EQ(page.read("hello")["role"], "observer");
  page.say(R"({"type":"line","id":1,"line":"hold all"})");
  EXPECT_EQ(page.read("answer")["done"], false);
}

TEST(Server, WithoutPasswordsIsForLoopbackOnly) {
  ServerConfig config;
  config.port = 0;
  config.address = "0.0.0.0";
  const auto open = [&] { return Server::open(config, [] {}); };
  EXPECT_FALSE(open().ok());
  config.log_in = with_users().log_in;
  const auto no_certificate = open();
  ASSERT_FALSE(no_certificate.ok());
  EXPECT_THAT(no_certificate.error().message, HasSubstr("certificate"));
}

TEST(Server, SaysWhatItCannotRead) {
  ServerConfig config;
  config.port = 0;
  config.tiles = "/nowhere";
  EXPECT_FALSE(Server::open(config, [] {}).ok());
  config.tiles.clear();
  config.overlays = {{"area", "/nowhere.geojson"}};
  EXPECT_FALSE(Server::open(config, [] {}).ok());
  config.overlays.clear();
  const Station first;
  config.port = first.port();
  const auto taken = Server::open(config, [] {});
  ASSERT_FALSE(taken.ok());
  EXPECT_THAT(taken.error().message, HasSubstr("in use"));
}

TEST(Server, GivesTilesAndOverlays) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("skein-console-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder / "tiles" / "3" / "1");
  std::ofstream{folder / "tiles" / "3" / "1" / "2.png"} << "picture";
  std::ofstream{folder / "secret.png"} << "secret";
  std::ofstream{folder / "area.geojson"} << R"({"type":"FeatureCollection","features":[]})";
  ServerConfig config;
  config.tiles = folder / "tiles";
  config.overlays = {{"area", folder / "area.geojson"}};
  config.groups = {{"copters", {2, 5}}};
  const Station station{config};
  const auto tile = ask(station, get("/tiles/3/1/2"));
  EXPECT_EQ(tile.body(), "picture");
  EXPECT_EQ(tile[http::field::content_type], "image/png");
  for (const char* none : {"/tiles/3/1/3", "/tiles/3/1", "/tiles/3/1/2/", "/tiles/-1/1/2",
                           "/tiles/../../secret", "/tiles/3/1/..%2f..%2f..%2fsecret"}) {
    EXPECT_EQ(ask(station, get(none)).result(), http::status::not_found) << none;
  }
  EXPECT_THAT(ask(station, get("/overlays/area")).body(), HasSubstr("FeatureCollection"));
  Page page{station};
  const Json hello = page.read("hello");
  EXPECT_EQ(hello["tiles"]["min_zoom"], 3);
  EXPECT_EQ(hello["overlays"][0]["url"], "/overlays/area");
  EXPECT_EQ(hello["groups"][0]["name"], "copters");
  EXPECT_EQ(hello["groups"][0]["vehicles"], (std::vector<int>{2, 5}));
  std::filesystem::remove_all(folder);
}

TEST(Server, TellsMachinesHowItIs) {
  Station station;
  EXPECT_EQ(ask(station, get("/health")).result(), http::status::service_unavailable);
  station.server().report({true, "{}", "skein_up 1\n"});
  EXPECT_EQ(ask(station, get("/health")).result(), http::status::ok);
  const auto metrics = ask(station, get("/metrics"));
  EXPECT_EQ(metrics.body(), "skein_up 1\n");
  EXPECT_THAT(std::string{metrics[http::field::content_type]}, HasSubstr("version=0.0.4"));
  station.server().report({false, "{\"healthy\":false}", ""});
  EXPECT_EQ(ask(station, get("/health")).result(), http::status::service_unavailable);
  auto foreign = get("/metrics");
  foreign.set(http::field::host, "example.org");
  EXPECT_EQ(ask(station, foreign).result(), http::status::misdirected_request);
}

TEST(MachinePages, AreForThisMachineAndForWhoHasLoggedIn) {
  const Gate gate{true, "", true};
  MachinePages pages{gate};
  const MachinePages::Time now{};
  pages.report({true, "{}", "m"}, now);
  HttpRequest request;
  request.target = "/metrics";
  request.host = "ground.example.org";
  EXPECT_EQ(pages.respond(request, now)->status, HttpStatus::unauthorized);
  request.local = true;
  EXPECT_EQ(pages.respond(request, now)->status, HttpStatus::ok);
  EXPECT_EQ(pages.respond(request, now + MachinePages::kReportAgeMax * 2)->status,
            HttpStatus::service_unavailable);
  request.target = "/";
  EXPECT_FALSE(pages.respond(request, now));
}

TEST(Server, SpeaksToFoxgloveClients) {
  Station station;
  const Server::LiveRecord record{
      "/vehicle_01/telemetry", "skein/msg/Telemetry", "float64 x", 7, {1, 2, 3}};
  for (const char* protocol : {"foxglove.websocket.v1", "foxglove.sdk.v1"}) {
    Page client{station, {.protocol = protocol, .path = "/"}};
    ASSERT_TRUE(client.open()) << protocol;
    EXPECT_EQ(Json::parse(client.read())["op"], "serverInfo");
    Json channels = Json::parse(client.read())["channels"];
    if (channels.empty()) {  // the first client, before the first record
      station.server().live(record);
      channels = Json::parse(client.read())["channels"];
    }
    ASSERT_EQ(channels.size(), 1U);
    EXPECT_EQ(channels[0]["topic"], "/vehicle_01/telemetry");
    EXPECT_EQ(channels[0]["schemaEncoding"], "ros2msg");
    client.say(R"({"op":"subscribe","subscriptions":[{"id":42,"channelId":1}]})");
    // What was sent before it subscribed does not come; so it goes on until something does.
    std::atomic<bool> came{false};
    std::thread sender{[&] {
      while (!came) {
        station.server().live(record);
        std::this_thread::sleep_for(std::chrono::milliseconds{5});
      }
    }};
    const std::string data = client.read();
    came = true;
    sender.join();
    EXPECT_EQ(data, std::string("\x01\x2a\0\0\0\x07\0\0\0\0\0\0\0\x01\x02\x03", 16));
  }
  Page nonsense{station, {.protocol = "foxglove.sdk.v1"}};
  nonsense.say(R"({"op":"subscribe","subscriptions":[{"id":-1}]})");
  while (!nonsense.read().empty()) {
  }
  EXPECT_FALSE(nonsense.open());
}

TEST(Users, AFileThatIsWrongSaysWhere) {
  EXPECT_FALSE(Users::load("/nowhere").ok());
  EXPECT_FALSE(Users::parse("# nobody\n", "f").ok());
  for (const char* wrong : {"ada", "ada:operator", "ada:boss:x", "ada:operator:x",
                            ":operator:pbkdf2-sha256$1000$00$00", "a:operator:md5$1$2$3"}) {
    const auto users = Users::parse(std::string{"# file\n"} + wrong, "f");
    ASSERT_FALSE(users.ok()) << wrong;
    EXPECT_THAT(users.error().message, HasSubstr("f:2:")) << wrong;
  }
}

TEST(Users, OfALineTwiceTheLastCounts) {
  const auto users = Users::parse("ada:operator:" + hash_password("the first", "5a17", 1000) +
                                      "\nada:observer:" + hash_password("the last", "5a18", 1000),
                                  "f");
  ASSERT_TRUE(users.ok());
  EXPECT_THAT(users->repeated(), ElementsAre("ada"));
  EXPECT_FALSE(users->check("ada", "the first"));
  EXPECT_EQ(users->check("ada", "the last"), Role::observer);
}

/// RFC 7914, section 11.
TEST(Users, TheHashIsPbkdf2) {
  EXPECT_EQ(hash_password("passwd", "salt", 1),
            "pbkdf2-sha256$1$salt$"
            "55ac046e56e3089fec1691c22544b605f94185216dde0465e68b9d57c20dacbc");
}

}  // namespace
}  // namespace skein::console
