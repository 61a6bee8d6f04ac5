// SPDX-License-Identifier: Apache-2.0
#include "stream.hpp"

#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/stream_traits.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cstdint>
#include <utility>

#include "byte_stream.hpp"

namespace skein::console {
namespace {

namespace http = boost::beast::http;

using BeastRequest = http::request<http::string_body>;

std::string_view view(boost::beast::string_view text) { return {text.data(), text.size()}; }
boost::beast::string_view beast_view(std::string_view text) { return {text.data(), text.size()}; }

HttpMethod method_of(const BeastRequest& request) {
  switch (request.method()) {
    case http::verb::get:
      return HttpMethod::get;
    case http::verb::head:
      return HttpMethod::head;
    case http::verb::post:
      return HttpMethod::post;
    case http::verb::delete_:
      return HttpMethod::remove;
    default:
      return HttpMethod::other;
  }
}

HttpRequest plain(const BeastRequest& request) {
  const auto field = [&](http::field name) { return std::string{view(request[name])}; };
  HttpRequest plain;
  plain.method = method_of(request);
  plain.target = view(request.target());
  plain.host = field(http::field::host);
  plain.origin = field(http::field::origin);
  plain.cookie = field(http::field::cookie);
  plain.body = request.body();
  plain.wants_socket = boost::beast::websocket::is_upgrade(request);
  for (const auto& one : http::token_list{request[http::field::sec_websocket_protocol]}) {
    plain.subprotocols.emplace_back(view(one));
  }
  return plain;
}

class BeastWebSocket final : public WebSocket {
 public:
  BeastWebSocket(AnyStream stream, BeastRequest request)
      : socket_{std::move(stream)}, request_{std::move(request)} {}

  void accept(std::string_view subprotocol, std::size_t read_max,
              std::function<void(bool)> done) override {
    namespace websocket = boost::beast::websocket;
    socket_.set_option(websocket::stream_base::timeout::suggested(boost::beast::role_type::server));
    socket_.set_option(websocket::stream_base::decorator(
        [protocol = std::string{subprotocol}](websocket::response_type& response) {
          response.set(http::field::server, "skein");
          response.set(http::field::sec_websocket_protocol, protocol);
        }));
    socket_.read_message_max(read_max);
    socket_.async_accept(
        request_, [done = std::move(done)](boost::beast::error_code error) { done(!error); });
  }

  void read(std::function<void(std::optional<Text>)> done) override {
    socket_.async_read(buffer_, [this, done = std::move(done)](boost::beast::error_code error,
                                                               std::size_t /*size*/) {
      if (error) return done(std::nullopt);
      Text text{!socket_.got_text(), boost::beast::buffers_to_string(buffer_.data())};
      buffer_.consume(buffer_.size());
      done(std::move(text));
    });
  }

  void write(std::string_view bytes, bool binary, std::function<void(bool)> done) override {
    socket_.binary(binary);
    socket_.async_write(boost::asio::buffer(bytes),
                        [done = std::move(done)](boost::beast::error_code error,
                                                 std::size_t /*size*/) { done(!error); });
  }

  void close_for_policy(std::function<void()> done) override {
    socket_.async_close(boost::beast::websocket::close_code::policy_error,
                        [done = std::move(done)](boost::beast::error_code /*error*/) { done(); });
  }

  void drop() override { socket_.next_layer()->close(); }

 private:
  boost::beast::websocket::stream<AnyStream, false> socket_;  // nothing is compressed
  BeastRequest request_;
  boost::beast::flat_buffer buffer_;
};

class BeastHttpStream final : public HttpStream {
 public:
  BeastHttpStream(AnyStream stream, bool secure) : stream_{std::move(stream)}, secure_{secure} {}

  void handshake(std::function<void(bool)> done) override {
    stream_->expire_after(kPatience);
    stream_->handshake([done = std::move(done)](boost::beast::error_code error) { done(!error); });
  }

  void read(std::function<void(std::optional<HttpRequest>)> done) override {
    parser_.emplace();
    parser_->body_limit(kBodyMax);
    parser_->header_limit(kHeaderMax);
    stream_->expire_after(kPatience);
    http::async_read(
        stream_, buffer_, *parser_,
        [this, done = std::move(done)](boost::beast::error_code error, std::size_t /*size*/) {
          if (error) return done(std::nullopt);
          request_ = parser_->release();
          done(plain(request_));
        });
  }

  void write(HttpResponse response, std::function<void(bool)> done) override {
    response_ = http::response<http::string_body>{
        static_cast<http::status>(static_cast<unsigned>(response.status)), request_.version()};
    response_.set(http::field::server, "skein");
    response_.set(http::field::content_type, beast_view(response.type));
    response_.set("Content-Security-Policy", kPolicy);
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("Referrer-Policy", "no-referrer");
    response_.set("Cross-Origin-Opener-Policy", "same-origin");
    response_.set("Cross-Origin-Resource-Policy", "same-origin");
    response_.set(http::field::cache_control, "no-store");
    if (secure_) response_.set("Strict-Transport-Security", "max-age=31536000");
    for (const auto& [name, value] : response.fields) response_.set(beast_view(name), value);
    response_.keep_alive(request_.keep_alive() && !response.last);
    response_.content_length(response.body.size());
    // Of an answer to HEAD only the length is said.
    if (request_.method() != http::verb::head) response_.body() = std::move(response.body);
    stream_->expire_after(kPatience);
    http::async_write(
        stream_, response_,
        [this, done = std::move(done)](boost::beast::error_code error, std::size_t /*size*/) {
          done(!error && !response_.need_eof());
        });
  }

  [[nodiscard]] std::unique_ptr<WebSocket> upgrade() override {
    stream_->never_expire();
    return std::make_unique<BeastWebSocket>(std::move(stream_), std::move(request_));
  }

  void close() override { stream_->end_sending(); }
  void drop() override { stream_->close(); }

 private:
  static constexpr const char* kPolicy =
      "default-src 'self'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'";
  static constexpr std::chrono::seconds kPatience{30};
  static constexpr std::uint64_t kBodyMax = 4096;
  static constexpr std::uint32_t kHeaderMax = 8192;

  AnyStream stream_;
  bool secure_;
  boost::beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  BeastRequest request_;
  http::response<http::string_body> response_;
};

}  // namespace

std::unique_ptr<HttpStream> open_http(std::unique_ptr<ByteStream> bytes, bool secure) {
  return std::make_unique<BeastHttpStream>(AnyStream{std::move(bytes)}, secure);
}

}  // namespace skein::console
