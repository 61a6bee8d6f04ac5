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

class BeastWebSocket final : public WebSocket {
 public:
  explicit BeastWebSocket(AnyStream stream) : socket_{std::move(stream)} {}

  void accept(const HttpRequest& request, std::string_view subprotocol, std::size_t read_max,
              std::function<void(bool)> done) override {
    namespace websocket = boost::beast::websocket;
    socket_.set_option(websocket::stream_base::timeout::suggested(boost::beast::role_type::server));
    socket_.set_option(websocket::stream_base::decorator(
        [protocol = std::string{subprotocol}](websocket::response_type& response) {
          response.set(boost::beast::http::field::server, "skein");
          response.set(boost::beast::http::field::sec_websocket_protocol, protocol);
        }));
    socket_.read_message_max(read_max);
    socket_.async_accept(
        request, [done = std::move(done)](boost::beast::error_code error) { done(!error); });
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
  boost::beast::flat_buffer buffer_;
};

class BeastHttpStream final : public HttpStream {
 public:
  explicit BeastHttpStream(AnyStream stream) : stream_{std::move(stream)} {}

  void handshake(std::function<void(bool)> done) override {
    stream_->expire_after(kPatience);
    stream_->handshake([done = std::move(done)](boost::beast::error_code error) { done(!error); });
  }

  void read(std::function<void(std::optional<HttpRequest>)> done) override {
    parser_.emplace();
    parser_->body_limit(kBodyMax);
    parser_->header_limit(kHeaderMax);
    stream_->expire_after(kPatience);
    boost::beast::http::async_read(
        stream_, buffer_, *parser_,
        [this, done = std::move(done)](boost::beast::error_code error, std::size_t /*size*/) {
          if (error) return done(std::nullopt);
          done(parser_->release());
        });
  }

  void write(HttpResponse response, std::function<void(bool)> done) override {
    response_ = std::move(response);
    stream_->expire_after(kPatience);
    boost::beast::http::async_write(
        stream_, response_,
        [this, done = std::move(done)](boost::beast::error_code error, std::size_t /*size*/) {
          done(!error && !response_.need_eof());
        });
  }

  [[nodiscard]] std::unique_ptr<WebSocket> upgrade() override {
    stream_->never_expire();
    return std::make_unique<BeastWebSocket>(std::move(stream_));
  }

  void close() override { stream_->end_sending(); }

 private:
  static constexpr std::chrono::seconds kPatience{30};
  static constexpr std::uint64_t kBodyMax = 4096;
  static constexpr std::uint32_t kHeaderMax = 8192;

  AnyStream stream_;
  boost::beast::flat_buffer buffer_;
  std::optional<boost::beast::http::request_parser<boost::beast::http::string_body>> parser_;
  HttpResponse response_;
};

}  // namespace

std::unique_ptr<HttpStream> open_stream(boost::asio::ip::tcp::socket socket,
                                        boost::asio::ssl::context* tls) {
  return std::make_unique<BeastHttpStream>(AnyStream{
      tls != nullptr ? open_tls(std::move(socket), *tls) : open_plain(std::move(socket))});
}

}  // namespace skein::console
