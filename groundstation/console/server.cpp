// SPDX-License-Identifier: Apache-2.0
#include "skein/console/server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <boost/beast/ssl.hpp>
#include <chrono>
#include <deque>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>
#include <utility>

#include "board.hpp"
#include "foxglove.hpp"
#include "gate.hpp"
#include "page_text.hpp"
#include "pages.hpp"
#include "skein/base/bounded_queue.hpp"

namespace skein::console {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace ssl = asio::ssl;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using beast::error_code;
using Json = nlohmann::json;

constexpr std::size_t kConnectionsMax = 64;
constexpr std::size_t kTextMax = 4096;
constexpr std::uint32_t kHeaderMax = 8192;
constexpr std::size_t kAnswersMax = 256;  ///< that wait for a slow client
constexpr std::size_t kRequestsMax = 256;
constexpr int kPublicationsMax = 4;
constexpr int kTextsPerSecond = 20;
constexpr std::size_t kLoginsMax = 4;  ///< that wait; each takes some 0.1 s
constexpr auto kPatience = std::chrono::seconds{30};
constexpr auto kAcceptAgain = std::chrono::milliseconds{200};
constexpr std::size_t kFoxgloveTextMax = 1U << 18U;  ///< a subscription to every topic
constexpr std::size_t kFoxgloveTextsMax = 65'536;    ///< that wait
constexpr std::size_t kFoxgloveBacklogMax = 4U
                                            << 20U;  ///< bytes that wait; then records are left out
constexpr std::string_view kSubprotocol = "skein.console.1";

std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

bool is_loopback(const std::string& address) {
  error_code error;
  const auto parsed = asio::ip::make_address(address, error);
  return !error && parsed.is_loopback();
}

/// Does the request offer this subprotocol?
bool offers(const HttpRequest& request, std::string_view protocol) {
  http::token_list offered{request[http::field::sec_websocket_protocol]};
  return offered.exists({protocol.data(), protocol.size()});
}

class Client {
 public:
  Client() = default;
  virtual ~Client() = default;
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  virtual void on_news() = 0;
  virtual void on_restart(const std::string& history, std::uint64_t next_seq) = 0;
};

/// One that speaks as Foxglove does.
class LiveClient {
 public:
  LiveClient() = default;
  virtual ~LiveClient() = default;
  LiveClient(const LiveClient&) = delete;
  LiveClient& operator=(const LiveClient&) = delete;
  virtual void on_channel(const LiveChannel& channel) = 0;
  virtual void on_record(std::uint32_t channel, const Server::LiveRecord& record) = 0;
};

}  // namespace

/// What all connections share. Everything but the requests belongs to the server's thread.
class Server::Impl {
 public:
  Impl(ServerConfig config, std::function<void()> on_request)
      : config_{std::move(config)},
        on_request_{std::move(on_request)},
        gate_{std::move(config_.users), !config_.certificate.empty()},
        run_{random_hex(8)} {}
  ~Impl() {
    logins_.stop();
    context_.stop();
    if (thread_.joinable()) thread_.join();
    logins_.join();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  Result<void> open();

  [[nodiscard]] std::string hello(const Identity& identity) const;
  /// False when too many wait.
  bool submit(Request request) {
    {
      const std::lock_guard lock{requests_mutex_};
      if (!requests_.push(std::move(request))) return false;
    }
    on_request_();
    return true;
  }
  std::optional<Request> next() {
    const std::lock_guard lock{requests_mutex_};
    return requests_.pop();
  }
  /// Work for the server's thread.
  template <class F>
  void post(F work) {
    asio::post(context_, std::move(work));
  }
  /// From another thread. Where the server's is behind, a state is left out: a newer one comes.
  void publish_soon(double time_s, Sections sections) {
    if (publications_ >= kPublicationsMax) return;
    ++publications_;
    post([this, time_s, sections = std::move(sections)]() mutable {
      --publications_;
      publish(time_s, std::move(sections));
    });
  }
  void publish(double time_s, Sections sections) {
    board_.publish(time_s, std::move(sections));
    tell_all();
  }
  void append(std::vector<std::string> events) {
    board_.append(std::move(events));
    tell_all();
  }
  void restart(std::uint64_t next_seq, const std::string& series) {
    board_.truncate(next_seq);
    const std::string history = board_.history(series);
    for (Client* client : std::vector<Client*>{clients_.begin(), clients_.end()}) {
      client->on_restart(history, next_seq);
    }
  }
  void join(Client& client) {
    clients_.insert(&client);
    watched_ = true;
  }
  void leave(Client& client) {
    clients_.erase(&client);
    watched_ = !clients_.empty();
  }
  void live(const LiveRecord& record) {
    auto channel = std::find_if(channels_.begin(), channels_.end(),
                                [&](const auto& known) { return known.topic == record.topic; });
    const std::vector<LiveClient*> all{live_clients_.begin(), live_clients_.end()};
    if (channel == channels_.end()) {
      channels_.push_back({static_cast<std::uint32_t>(channels_.size() + 1), record.topic,
                           std::string{record.schema_name}, std::string{record.schema}});
      channel = std::prev(channels_.end());
      for (LiveClient* client : all) client->on_channel(*channel);
    }
    for (LiveClient* client : all) client->on_record(channel->id, record);
  }
  void join(LiveClient& client) {
    live_clients_.insert(&client);
    live_watched_ = true;
  }
  void leave(LiveClient& client) {
    live_clients_.erase(&client);
    live_watched_ = !live_clients_.empty();
  }
  [[nodiscard]] const std::vector<LiveChannel>& channels() const { return channels_; }
  [[nodiscard]] const std::string& run_id() const { return run_; }
  [[nodiscard]] bool live_watched() const { return live_watched_; }

  /// Checks a password on a thread of its own. False when too many wait.
  bool log_in(std::string user, std::string password,
              std::function<void(std::optional<Identity>)> done) {
    if (logins_waiting_ >= kLoginsMax) return false;
    ++logins_waiting_;
    asio::post(logins_, [this, user = std::move(user), password = std::move(password),
                         done = std::move(done)]() mutable {
      auto identity = gate_.check(user, password);
      post([this, identity = std::move(identity), done = std::move(done)] {
        --logins_waiting_;
        done(identity);
      });
    });
    return true;
  }

  [[nodiscard]] Gate& gate() { return gate_; }
  [[nodiscard]] const Pages& pages() const { return *pages_; }
  [[nodiscard]] const Board& board() const { return board_; }
  [[nodiscard]] bool watched() const { return watched_; }
  [[nodiscard]] std::string url() const;

  /// Counts a connection as long as it lives.
  class Place {
   public:
    explicit Place(Impl& impl) : impl_{&impl} { ++impl.connections_; }
    ~Place() { --impl_->connections_; }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

   private:
    Impl* impl_;
  };

 private:
  void tell_all() {
    for (Client* client : std::vector<Client*>{clients_.begin(), clients_.end()}) client->on_news();
  }
  void run();
  void accept();
  void serve(tcp::socket socket);

  ServerConfig config_;
  std::function<void()> on_request_;
  Gate gate_;
  std::string run_;
  Json hello_;
  std::optional<Pages> pages_;
  Board board_;
  std::optional<ssl::context> tls_;
  std::uint16_t port_ = 0;
  std::size_t logins_waiting_ = 0;
  std::size_t connections_ = 0;
  std::set<Client*> clients_;
  std::atomic<bool> watched_{false};
  std::atomic<int> publications_{0};  ///< that wait for the server's thread
  std::vector<LiveChannel> channels_;
  std::set<LiveClient*> live_clients_;
  std::atomic<bool> live_watched_{false};
  std::mutex requests_mutex_;
  BoundedQueue<Request> requests_{kRequestsMax};
  asio::io_context context_{1};  // last but one: its connections use what stands above
  tcp::acceptor acceptor_{context_};
  asio::steady_timer accept_again_{context_};
  asio::thread_pool logins_{1};
  std::thread thread_;
};

namespace {

/// A client of the page's socket. `Stream` is TCP, or TLS on it.
template <class Stream>
class SocketClient final : public Client,
                           public std::enable_shared_from_this<SocketClient<Stream>> {
 public:
  SocketClient(Server::Impl& server, Stream stream, Identity identity,
               std::shared_ptr<Server::Impl::Place> place)
      : server_{server},
        socket_{std::move(stream)},
        identity_{std::move(identity)},
        place_{std::move(place)} {}
  ~SocketClient() override { server_.leave(*this); }
  SocketClient(const SocketClient&) = delete;
  SocketClient& operator=(const SocketClient&) = delete;

  void run(const HttpRequest& request) {
    socket_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
    socket_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
      response.set(http::field::server, "skein");
      response.set(http::field::sec_websocket_protocol,
                   beast::string_view{kSubprotocol.data(), kSubprotocol.size()});
    }));
    socket_.read_message_max(kTextMax);
    cookies_ = view(request[http::field::cookie]);
    socket_.async_accept(request, [self = this->shared_from_this()](error_code error) {
      if (error) return;
      self->server_.join(*self);
      self->say(self->server_.hello(self->identity_));
      self->read();
    });
  }

  void on_news() override { write(); }
  void on_restart(const std::string& history, std::uint64_t next_seq) override {
    if (!resumed_) return;
    seen_.next_seq = std::min(seen_.next_seq, next_seq);
    say(history);
  }

 private:
  void read() {
    socket_.async_read(buffer_, [self = this->shared_from_this()](error_code error, std::size_t) {
      if (error) return self->stop();
      const std::string text = beast::buffers_to_string(self->buffer_.data());
      self->buffer_.consume(self->buffer_.size());
      if (!self->in_time()) return self->close(websocket::close_code::policy_error);
      if (!self->on_text(text)) return self->close(websocket::close_code::policy_error);
      self->read();
    });
  }

  /// Not more than kTextsPerSecond.
  [[nodiscard]] bool in_time() {
    const auto now = std::chrono::steady_clock::now();
    if (now - second_begun_ >= std::chrono::seconds{1}) {
      second_begun_ = now;
      texts_ = 0;
    }
    return ++texts_ <= kTextsPerSecond;
  }

  /// False for what no page of ours says.
  [[nodiscard]] bool on_text(const std::string& text) {
    auto parsed = parse_page_text(text);
    if (!parsed) return false;
    return std::visit([this](auto& said) { return on(said); }, *parsed);
  }

  bool on(const PingText& ping) {
    say(text_of({{"type", "pong"}, {"id", ping.id}, {"time_s", server_.board().time_s()}}));
    return true;
  }

  bool on(const ResumeText& resume) {
    if (asked_) return false;
    asked_ = true;
    seen_.next_seq = resume.next_seq;
    // From a later time than ours: of another run.
    if (seen_.next_seq > server_.board().next_seq()) seen_.next_seq = 0;
    return server_.submit(
        Server::Join{[server = &server_, self = weak()](const std::string& series) {
          server->post([self, series] {
            if (const auto client = self.lock()) client->begin(series);
          });
        }});
  }

  void begin(const std::string& series) {
    // A replay may have been wound back meanwhile.
    seen_.next_seq = std::min(seen_.next_seq, server_.board().next_seq());
    say(server_.board().history(series));
    resumed_ = true;
    write();
  }

  bool on(LineText& text) {
    // Who has logged out gives no more orders by what is still open.
    if (!server_.gate().identify(cookies_, std::chrono::steady_clock::now())) return false;
    Server::Line given;
    given.line = std::move(text.line);
    given.user = identity_.user;
    given.may_order = identity_.role == Role::op;
    given.order = std::move(text.order);
    // Called on other threads: only the server's may be the last to hold a client.
    given.reply = [server = &server_, self = weak(), id = text.id](
                      bool done, const std::string& said, const std::string& data) {
      server->post([self, answer = fmt::format(
                              R"({{"type":"answer","id":{},"done":{},"text":{},"data":{}}})", id,
                              done, text_of(said), data.empty() ? "null" : data)] {
        if (const auto client = self.lock()) client->say(answer);
      });
    };
    const auto reply = given.reply;
    if (!server_.submit(std::move(given))) reply(false, "the ground station is too busy\n", "");
    return true;
  }

  [[nodiscard]] std::weak_ptr<SocketClient> weak() { return this->weak_from_this(); }

  void say(std::string text) {
    if (answers_.size() >= kAnswersMax) return stop();
    answers_.push_back(std::move(text));
    write();
  }

  /// What was asked for first, then events, then the newest state: one text at a time.
  void write() {
    if (writing_ || stopped_) return;
    if (!answers_.empty()) {
      text_ = std::move(answers_.front());
      answers_.pop_front();
    } else if (resumed_ && server_.board().has_events(seen_)) {
      text_ = server_.board().events(seen_);
    } else if (resumed_ && server_.board().has_state(seen_)) {
      text_ = server_.board().state(seen_);
    } else {
      return;
    }
    writing_ = true;
    socket_.text(true);
    socket_.async_write(asio::buffer(text_),
                        [self = this->shared_from_this()](error_code error, std::size_t) {
                          self->writing_ = false;
                          if (error) return self->stop();
                          self->write();
                        });
  }

  void close(websocket::close_code code) {
    if (stopped_) return;
    stopped_ = true;
    server_.leave(*this);
    if (writing_) return drop();  // a close may not overtake a text
    socket_.async_close(code, [self = this->shared_from_this()](error_code) {});
  }
  void stop() {
    stopped_ = true;
    server_.leave(*this);
    drop();
  }
  void drop() { beast::get_lowest_layer(socket_).close(); }

  Server::Impl& server_;
  websocket::stream<Stream> socket_;
  Identity identity_;
  std::string cookies_;
  std::shared_ptr<Server::Impl::Place> place_;
  beast::flat_buffer buffer_;
  std::deque<std::string> answers_;
  std::string text_;  ///< that is being written
  Board::Seen seen_;
  bool asked_ = false;    ///< to resume
  bool resumed_ = false;  ///< has its history
  bool writing_ = false;
  bool stopped_ = false;
  std::chrono::steady_clock::time_point second_begun_{};
  int texts_ = 0;
};

/// A client that speaks as Foxglove does. Records that it does not take in time are left out.
template <class Stream>
class FoxgloveClient final : public LiveClient,
                             public std::enable_shared_from_this<FoxgloveClient<Stream>> {
 public:
  FoxgloveClient(Server::Impl& server, Stream stream, std::string_view protocol,
                 std::shared_ptr<Server::Impl::Place> place)
      : server_{server},
        socket_{std::move(stream)},
        protocol_{protocol},
        place_{std::move(place)} {}
  ~FoxgloveClient() override { server_.leave(*this); }
  FoxgloveClient(const FoxgloveClient&) = delete;
  FoxgloveClient& operator=(const FoxgloveClient&) = delete;

  void run(const HttpRequest& request) {
    socket_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
    socket_.set_option(websocket::stream_base::decorator(
        [protocol = protocol_](websocket::response_type& response) {
          response.set(http::field::sec_websocket_protocol, protocol);
        }));
    socket_.read_message_max(kFoxgloveTextMax);
    socket_.async_accept(request, [self = this->shared_from_this()](error_code error) {
      if (error) return;
      self->server_.join(*self);
      self->say(FoxgloveSession::server_info("skein-ground", self->server_.run_id()));
      self->say(FoxgloveSession::advertise(self->server_.channels()));
      self->read();
    });
  }

  void on_channel(const LiveChannel& channel) override {
    say(FoxgloveSession::advertise({&channel, 1}));
  }
  void on_record(std::uint32_t channel, const Server::LiveRecord& record) override {
    if (waiting_bytes_ > kFoxgloveBacklogMax) return;
    if (auto message = session_.record(channel, record.time_ns, record.bytes)) {
      push({true, std::move(*message)});
    }
  }

 private:
  struct Text {
    bool binary = false;
    std::string bytes;
  };

  void read() {
    socket_.async_read(buffer_, [self = this->shared_from_this()](error_code error, std::size_t) {
      if (error) return self->stop();
      const bool good = !self->socket_.got_text() ||
                        self->session_.on_text(beast::buffers_to_string(self->buffer_.data()));
      self->buffer_.consume(self->buffer_.size());
      if (!good) return self->stop();
      self->read();
    });
  }
  void say(std::string text) {
    if (texts_.size() > kFoxgloveTextsMax) return stop();
    push({false, std::move(text)});
  }
  void push(Text text) {
    waiting_bytes_ += text.bytes.size();
    texts_.push_back(std::move(text));
    write();
  }
  void write() {
    if (writing_ || stopped_ || texts_.empty()) return;
    writing_ = true;
    socket_.binary(texts_.front().binary);
    socket_.async_write(asio::buffer(texts_.front().bytes),
                        [self = this->shared_from_this()](error_code error, std::size_t) {
                          self->writing_ = false;
                          self->waiting_bytes_ -= self->texts_.front().bytes.size();
                          self->texts_.pop_front();
                          if (error) return self->stop();
                          self->write();
                        });
  }
  void stop() {
    stopped_ = true;
    server_.leave(*this);
    beast::get_lowest_layer(socket_).close();
  }

  Server::Impl& server_;
  websocket::stream<Stream> socket_;
  std::string protocol_;
  std::shared_ptr<Server::Impl::Place> place_;
  FoxgloveSession session_;
  beast::flat_buffer buffer_;
  std::deque<Text> texts_;
  std::size_t waiting_bytes_ = 0;
  bool writing_ = false;
  bool stopped_ = false;
};

/// A connection that speaks HTTP, until it asks for the socket.
template <class Stream>
class HttpConnection final : public std::enable_shared_from_this<HttpConnection<Stream>> {
 public:
  HttpConnection(Server::Impl& server, Stream stream)
      : server_{server},
        stream_{std::move(stream)},
        place_{std::make_shared<Server::Impl::Place>(server)} {}

  void run() {
    if constexpr (std::is_same_v<Stream, beast::tcp_stream>) {
      read();
    } else {
      beast::get_lowest_layer(stream_).expires_after(kPatience);
      stream_.async_handshake(ssl::stream_base::server,
                              [self = this->shared_from_this()](error_code error) {
                                if (!error) self->read();
                              });
    }
  }

 private:
  void read() {
    parser_.emplace();
    parser_->body_limit(kTextMax);
    parser_->header_limit(kHeaderMax);
    beast::get_lowest_layer(stream_).expires_after(kPatience);
    http::async_read(stream_, buffer_, *parser_,
                     [self = this->shared_from_this()](error_code error, std::size_t) {
                       if (error) return self->close();
                       self->handle(self->parser_->release());
                     });
  }

  void handle(HttpRequest request) {
    if (websocket::is_upgrade(request)) return upgrade(request);
    if (request.target() == "/session" && request.method() == http::verb::post) {
      return log_in(request);
    }
    if (request.target() == "/session" && request.method() == http::verb::delete_) {
      HttpResponse response = answer(request, http::status::ok, "application/json", "{}");
      response.set(http::field::set_cookie,
                   server_.gate().dismiss(view(request[http::field::cookie])));
      return send(std::move(response));
    }
    send(server_.pages().respond(request));
  }

  void upgrade(const HttpRequest& request) {
    const Gate& gate = server_.gate();
    const auto host = view(request[http::field::host]);
    const auto refuse = [&](http::status status, const char* why) {
      send(answer(request, status, "text/plain; charset=utf-8", std::string{why} + "\n"));
    };
    if (!gate.is_own_host(host) || !gate.is_own_origin(view(request[http::field::origin]), host)) {
      return refuse(http::status::forbidden, "the socket is for this server's own page");
    }
    const auto identity =
        gate.identify(view(request[http::field::cookie]), std::chrono::steady_clock::now());
    if (!identity) return refuse(http::status::unauthorized, "log in first");
    for (const std::string_view protocol : kFoxgloveProtocols) {
      if (!offers(request, protocol)) continue;
      beast::get_lowest_layer(stream_).expires_never();
      return std::make_shared<FoxgloveClient<Stream>>(server_, std::move(stream_), protocol, place_)
          ->run(request);
    }
    if (request.target() != "/socket" || !offers(request, kSubprotocol)) {
      return refuse(http::status::bad_request,
                    "the socket is at /socket and speaks skein.console.1");
    }
    beast::get_lowest_layer(stream_).expires_never();
    std::make_shared<SocketClient<Stream>>(server_, std::move(stream_), *identity, place_)
        ->run(request);
  }

  void log_in(const HttpRequest& request) {
    const auto refuse = [this, request](http::status status, const char* why) {
      send(answer(request, status, "application/json", text_of({{"error", why}})));
    };
    const auto host = view(request[http::field::host]);
    if (!server_.gate().is_own_origin(view(request[http::field::origin]), host)) {
      return refuse(http::status::forbidden, "the login is for this server's own page");
    }
    if (!server_.gate().asks_for_password()) {
      return refuse(http::status::bad_request, "nobody needs to log in here");
    }
    const Json json = Json::parse(request.body(), nullptr, false);
    if (!json.is_object() || !json.contains("user") || !json.contains("password") ||
        !json["user"].is_string() || !json["password"].is_string()) {
      return refuse(http::status::bad_request, "a login has a user and a password");
    }
    const bool taken = server_.log_in(
        json["user"], json["password"],
        [self = this->shared_from_this(), request, refuse](std::optional<Identity> identity) {
          if (!identity) return refuse(http::status::unauthorized, "wrong user or password");
          HttpResponse response =
              answer(request, http::status::ok, "application/json",
                     text_of({{"user", identity->user}, {"role", to_string(identity->role)}}));
          response.set(http::field::set_cookie,
                       self->server_.gate().admit(*identity, std::chrono::steady_clock::now()));
          self->send(std::move(response));
        });
    if (!taken) refuse(http::status::too_many_requests, "too many log in at once; try again");
  }

  void send(HttpResponse response) {
    response_ = std::move(response);
    beast::get_lowest_layer(stream_).expires_after(kPatience);
    http::async_write(stream_, response_,
                      [self = this->shared_from_this()](error_code error, std::size_t) {
                        if (error || self->response_.need_eof()) return self->close();
                        self->read();
                      });
  }

  void close() {
    error_code ignored;
    beast::get_lowest_layer(stream_).socket().shutdown(tcp::socket::shutdown_send, ignored);
  }

  Server::Impl& server_;
  Stream stream_;
  std::shared_ptr<Server::Impl::Place> place_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  HttpResponse response_;
};

}  // namespace

Result<void> Server::Impl::open() {
  if (!is_loopback(config_.address)) {
    if (!gate_.asks_for_password() || config_.certificate.empty() || config_.key.empty()) {
      return Error{"a console on " + config_.address +
                   " needs passwords, a certificate and its key; without them it is served on "
                   "127.0.0.1 only"};
    }
  }
  hello_ = Json::parse(config_.hello, nullptr, false);
  auto pages = Pages::open(config_, gate_);
  if (!pages) return pages.error();
  pages_.emplace(std::move(*pages));
  error_code error;
  if (!config_.certificate.empty()) {
    tls_.emplace(ssl::context::tls_server);
    tls_->set_options(ssl::context::default_workarounds | ssl::context::no_tlsv1 |
                      ssl::context::no_tlsv1_1);
    tls_->use_certificate_chain_file(config_.certificate, error);
    if (error) return Error{config_.certificate + ": no certificate: " + error.message()};
    tls_->use_private_key_file(config_.key, ssl::context::pem, error);
    if (error) return Error{config_.key + ": not the certificate's key: " + error.message()};
  }
  const auto address = asio::ip::make_address(config_.address, error);
  if (error)
    return Error{"'" + config_.address +
                 "' is no address; the console wants one such as 127.0.0.1"};
  const tcp::endpoint endpoint{address, config_.port};
  acceptor_.open(endpoint.protocol(), error);
  if (!error) acceptor_.set_option(asio::socket_base::reuse_address{true}, error);
  if (!error) acceptor_.bind(endpoint, error);
  if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
  if (error) {
    return Error{fmt::format("the console cannot listen on {} port {}: {}", config_.address,
                             config_.port, error.message())};
  }
  port_ = acceptor_.local_endpoint(error).port();
  accept();
  thread_ = std::thread{[this] { run(); }};
  return {};
}

void Server::Impl::run() {
  while (true) {
    try {
      context_.run();
      return;
    } catch (const std::exception&) {
      // A file that cannot be read, say: it ends one connection, not the ground station.
    }
  }
}

void Server::Impl::accept() {
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (error) {  // no descriptors, for instance
      accept_again_.expires_after(kAcceptAgain);
      accept_again_.async_wait([this](error_code stopped) {
        if (!stopped) accept();
      });
      return;
    }
    if (connections_ < kConnectionsMax) serve(std::move(socket));
    accept();
  });
}

void Server::Impl::serve(tcp::socket socket) {
  error_code ignored;
  socket.set_option(tcp::no_delay{true}, ignored);
  if (tls_) {
    using Tls = beast::ssl_stream<beast::tcp_stream>;
    std::make_shared<HttpConnection<Tls>>(*this, Tls{beast::tcp_stream{std::move(socket)}, *tls_})
        ->run();
  } else {
    std::make_shared<HttpConnection<beast::tcp_stream>>(*this, beast::tcp_stream{std::move(socket)})
        ->run();
  }
}

std::string Server::Impl::hello(const Identity& identity) const {
  Json hello = hello_;
  hello["type"] = "hello";
  hello["run"] = run_;
  hello["role"] = to_string(identity.role);
  hello["user"] = identity.user;
  hello["tiles"] = pages_->tiles() ? Json::parse(pages_->tiles()->description()) : Json(nullptr);
  hello["overlays"] = Json::array();
  for (const Overlay& overlay : config_.overlays) {
    hello["overlays"].push_back({{"name", overlay.name}, {"url", "/overlays/" + overlay.name}});
  }
  return text_of(hello);
}

std::string Server::Impl::url() const {
  const bool six = config_.address.find(':') != std::string::npos;
  return fmt::format("{}://{}{}{}:{}/", tls_ ? "https" : "http", six ? "[" : "", config_.address,
                     six ? "]" : "", port_);
}

Server::Server(std::unique_ptr<Impl> impl) : impl_{std::move(impl)} {}
Server::~Server() = default;

Result<std::unique_ptr<Server>> Server::open(ServerConfig config,
                                             std::function<void()> on_request) {
  auto impl = std::make_unique<Impl>(std::move(config), std::move(on_request));
  if (auto opened = impl->open(); !opened) return opened.error();
  return std::unique_ptr<Server>{new Server{std::move(impl)}};
}

std::optional<Server::Request> Server::next() { return impl_->next(); }
void Server::publish(double time_s, Sections sections) {
  impl_->publish_soon(time_s, std::move(sections));
}
void Server::append(std::vector<std::string> events) {
  impl_->post([impl = impl_.get(), events = std::move(events)]() mutable {
    impl->append(std::move(events));
  });
}
void Server::restart(std::uint64_t next_seq, const std::string& series) {
  impl_->post([impl = impl_.get(), next_seq, series] { impl->restart(next_seq, series); });
}
void Server::live(LiveRecord record) {
  impl_->post([impl = impl_.get(), record = std::move(record)] { impl->live(record); });
}
bool Server::live_watched() const { return impl_->live_watched(); }
bool Server::watched() const { return impl_->watched(); }
std::string Server::url() const { return impl_->url(); }

}  // namespace skein::console
