// SPDX-License-Identifier: Apache-2.0
#include "skein/ros2/console_client.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <charconv>
#include <optional>
#include <utility>

#include "skein/codec/json_text.hpp"

namespace skein::ros2 {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;

constexpr std::uint16_t kConsolePort = 7460;
constexpr const char* kProtocol = "skein.console.1";
constexpr std::chrono::seconds kPatience{10};
constexpr std::chrono::seconds kSilence{20};
constexpr std::size_t kTextMax = 64U << 20U;  // a picture of a thousand vehicles

}  // namespace

Result<Place> parse_place(std::string_view text) {
  const Error error{"'" + std::string{text} + "' is no place: 127.0.0.1:7460 is one"};
  const auto colon = text.find(':');
  Place place{std::string{text.substr(0, colon)}};
  error_code bad;
  asio::ip::make_address_v4(place.host, bad);
  if (bad) return error;
  if (colon == std::string_view::npos) return place;
  const std::string_view port = text.substr(colon + 1);
  const auto read = std::from_chars(port.data(), port.data() + port.size(), place.port);
  const bool whole = read.ec == std::errc{} && read.ptr == port.data() + port.size();
  if (!whole || place.port == 0) return error;
  return place;
}

Result<Place> parse_console(std::string_view url) {
  constexpr std::string_view kScheme = "http://";
  std::string_view rest = url;
  if (!rest.starts_with(kScheme)) {
    return Error{"'" + std::string{url} + "' is no console: http://127.0.0.1:7460 is one"};
  }
  rest.remove_prefix(kScheme.size());
  if (rest.ends_with('/')) rest.remove_suffix(1);
  auto place = parse_place(rest);
  if (place && place->port == 0) place->port = kConsolePort;
  return place;
}

class ConsoleClient::Session {
 public:
  Session(Config config, Events events) : config_{std::move(config)}, events_{std::move(events)} {
    connect();
  }

  void run_for(std::chrono::milliseconds time) {
    io_.restart();
    io_.run_for(time);
  }

 private:
  using WebSocket = websocket::stream<beast::tcp_stream>;

  [[nodiscard]] std::string host() const {
    return config_.address.host + ":" + std::to_string(config_.address.port);
  }

  void connect() {
    socket_.emplace(io_);
    buffer_.clear();
    auto& stream = beast::get_lowest_layer(*socket_);
    stream.expires_after(kPatience);
    const asio::ip::tcp::endpoint to{asio::ip::make_address_v4(config_.address.host),
                                     config_.address.port};
    stream.async_connect(to, [this](const error_code& error) {
      if (error) return fail(error.message());
      log_in();
    });
  }

  void log_in() {
    request_ = {http::verb::post, "/session", 11};
    request_.set(http::field::host, host());
    request_.set(http::field::content_type, "application/json");
    request_.body() = codec::json_text({{"user", config_.user}, {"password", config_.password}});
    request_.prepare_payload();
    auto& stream = beast::get_lowest_layer(*socket_);
    http::async_write(stream, request_, [this, &stream](const error_code& error, std::size_t) {
      if (error) return fail(error.message());
      response_ = {};
      http::async_read(stream, buffer_, response_, [this](const error_code& failed, std::size_t) {
        if (failed) return fail(failed.message());
        upgrade();
      });
    });
  }

  void upgrade() {
    if (response_.result() != http::status::ok) {
      const auto json = codec::parse_json(response_.body());
      const bool has_why = json.is_object() && json.contains("error") && json["error"].is_string();
      return fail(has_why ? json["error"].get<std::string>() : "the console refuses the login");
    }
    const std::string_view set{response_[http::field::set_cookie].data(),
                               response_[http::field::set_cookie].size()};
    std::string cookie{set.substr(0, set.find(';'))};
    beast::get_lowest_layer(*socket_).expires_never();
    // A console whose machine is gone says nothing of it.
    socket_->set_option(websocket::stream_base::timeout{kPatience, kSilence, true});
    socket_->set_option(websocket::stream_base::decorator(
        [cookie = std::move(cookie)](websocket::request_type& request) {
          request.set(http::field::cookie, cookie);
          request.set(http::field::sec_websocket_protocol, kProtocol);
        }));
    socket_->read_message_max(kTextMax);
    socket_->async_handshake(host(), "/socket", [this](const error_code& error) {
      if (error) return fail(error.message());
      events_.on_news("hears the console at " + host());
      told_ = false;
      read();
    });
  }

  void read() {
    socket_->async_read(buffer_, [this](const error_code& error, std::size_t) {
      if (error) return fail(error.message());
      const auto answer = events_.on_text(beast::buffers_to_string(buffer_.data()));
      buffer_.clear();
      if (!answer) return fail(answer.error().message);
      if (!answer->empty()) return write(*answer);
      read();
    });
  }

  void write(std::string text) {
    answer_ = std::move(text);
    socket_->text(true);
    socket_->async_write(asio::buffer(answer_), [this](const error_code& error, std::size_t) {
      if (error) return fail(error.message());
      read();
    });
  }

  void fail(const std::string& why) {
    if (!std::exchange(told_, true)) {
      events_.on_news("the console at " + host() + ": " + why + "; it is tried again");
    }
    error_code ignored;
    beast::get_lowest_layer(*socket_).socket().close(ignored);
    retry_.expires_after(kRetry);
    retry_.async_wait([this](const error_code& error) {
      if (!error) connect();
    });
  }

  Config config_;
  Events events_;
  asio::io_context io_;
  asio::steady_timer retry_{io_};
  std::optional<WebSocket> socket_;
  beast::flat_buffer buffer_;
  http::request<http::string_body> request_;
  http::response<http::string_body> response_;
  std::string answer_;
  bool told_ = false;  ///< of this failure
};

ConsoleClient::ConsoleClient(Config config, Events events)
    : session_{std::make_unique<Session>(std::move(config), std::move(events))} {}
ConsoleClient::~ConsoleClient() = default;

void ConsoleClient::run_for(std::chrono::milliseconds time) { session_->run_for(time); }

}  // namespace skein::ros2
