// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio.hpp>
#include <boost/asio/ssl/stream_base.hpp>
#include <boost/beast.hpp>
#include <chrono>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "stream.hpp"

/// The two of stream.hpp over TCP, or over TLS on it. Beast's templates weigh seconds for every
/// stream: each has a source of its own, and handlers have one type.

namespace skein::console {

template <class Stream>
class WebSocketOver final : public WebSocket {
 public:
  explicit WebSocketOver(Stream stream) : socket_{std::move(stream)} {}

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

  void drop() override { boost::beast::get_lowest_layer(socket_).close(); }

 private:
  boost::beast::websocket::stream<Stream, false> socket_;  // nothing is compressed
  boost::beast::flat_buffer buffer_;
};

template <class Stream>
class HttpStreamOver final : public HttpStream {
 public:
  explicit HttpStreamOver(Stream stream) : stream_{std::move(stream)} {}

  void handshake(std::function<void(bool)> done) override {
    if constexpr (std::is_same_v<Stream, boost::beast::tcp_stream>) {
      done(true);
    } else {
      boost::beast::get_lowest_layer(stream_).expires_after(kPatience);
      stream_.async_handshake(
          boost::asio::ssl::stream_base::server,
          [done = std::move(done)](boost::beast::error_code error) { done(!error); });
    }
  }

  void read(std::function<void(std::optional<HttpRequest>)> done) override {
    parser_.emplace();
    parser_->body_limit(kBodyMax);
    parser_->header_limit(kHeaderMax);
    boost::beast::get_lowest_layer(stream_).expires_after(kPatience);
    boost::beast::http::async_read(
        stream_, buffer_, *parser_,
        [this, done = std::move(done)](boost::beast::error_code error, std::size_t /*size*/) {
          if (error) return done(std::nullopt);
          done(parser_->release());
        });
  }

  void write(HttpResponse response, std::function<void(bool)> done) override {
    response_ = std::move(response);
    boost::beast::get_lowest_layer(stream_).expires_after(kPatience);
    boost::beast::http::async_write(
        stream_, response_,
        [this, done = std::move(done)](boost::beast::error_code error, std::size_t /*size*/) {
          done(!error && !response_.need_eof());
        });
  }

  [[nodiscard]] std::unique_ptr<WebSocket> upgrade() override {
    boost::beast::get_lowest_layer(stream_).expires_never();
    return std::make_unique<WebSocketOver<Stream>>(std::move(stream_));
  }

  void close() override {
    boost::beast::error_code ignored;
    boost::beast::get_lowest_layer(stream_).socket().shutdown(
        boost::asio::ip::tcp::socket::shutdown_send, ignored);
  }

 private:
  static constexpr std::chrono::seconds kPatience{30};
  static constexpr std::uint64_t kBodyMax = 4096;
  static constexpr std::uint32_t kHeaderMax = 8192;

  Stream stream_;
  boost::beast::flat_buffer buffer_;
  std::optional<boost::beast::http::request_parser<boost::beast::http::string_body>> parser_;
  HttpResponse response_;
};

}  // namespace skein::console
