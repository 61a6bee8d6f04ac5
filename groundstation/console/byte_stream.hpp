// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/beast/core/error.hpp>
#include <boost/beast/core/role.hpp>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace skein::console {

/// Bytes over TCP, or over TLS on it. Handlers are called by the thread of the socket's context.
class ByteStream {
 public:
  using Done = std::function<void(boost::beast::error_code, std::size_t)>;

  ByteStream() = default;
  virtual ~ByteStream() = default;
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  [[nodiscard]] virtual boost::asio::any_io_executor executor() = 0;
  virtual void handshake(std::function<void(boost::beast::error_code)> done) = 0;
  virtual void read_some(std::vector<boost::asio::mutable_buffer> buffers, Done done) = 0;
  virtual void write_some(std::vector<boost::asio::const_buffer> buffers, Done done) = 0;
  /// Of TLS first, then of the connection.
  virtual void shut_down(boost::beast::role_type role,
                         std::function<void(boost::beast::error_code)> done) = 0;
  /// Whatever is begun from now on fails after that.
  virtual void expire_after(std::chrono::seconds limit) = 0;
  virtual void never_expire() = 0;
  /// Says that nothing more comes; what was sent still arrives.
  virtual void end_sending() = 0;
  virtual void close() = 0;
};

[[nodiscard]] std::unique_ptr<ByteStream> open_plain(boost::asio::ip::tcp::socket socket);
[[nodiscard]] std::unique_ptr<ByteStream> open_tls(boost::asio::ip::tcp::socket socket,
                                                   boost::asio::ssl::context& tls);

/// A ByteStream as Beast wants it: an AsyncStream that moves. Beast's templates weigh 20 s of a
/// compiler for each type of stream; so there is one.
class AnyStream {
 public:
  using executor_type = boost::asio::any_io_executor;

  explicit AnyStream(std::unique_ptr<ByteStream> bytes) : bytes_{std::move(bytes)} {}

  [[nodiscard]] executor_type get_executor() { return bytes_->executor(); }
  ByteStream* operator->() { return bytes_.get(); }

  template <class Buffers, class Handler>
  void async_read_some(const Buffers& buffers, Handler&& handler) {
    bytes_->read_some(
        {boost::asio::buffer_sequence_begin(buffers), boost::asio::buffer_sequence_end(buffers)},
        copyable(std::forward<Handler>(handler)));
  }
  template <class Buffers, class Handler>
  void async_write_some(const Buffers& buffers, Handler&& handler) {
    bytes_->write_some(
        {boost::asio::buffer_sequence_begin(buffers), boost::asio::buffer_sequence_end(buffers)},
        copyable(std::forward<Handler>(handler)));
  }

  // What a WebSocket looks for by these names.
  template <class Handler>
  friend void async_teardown(boost::beast::role_type role, AnyStream& stream, Handler&& handler) {
    stream->shut_down(role, copyable(std::forward<Handler>(handler)));
  }
  friend void beast_close_socket(AnyStream& stream) { stream->close(); }

 private:
  /// Beast's handlers only move, and std::function wants a copy.
  template <class Handler>
  [[nodiscard]] static auto copyable(Handler&& handler) {
    return [kept = std::make_shared<std::decay_t<Handler>>(std::forward<Handler>(handler))](
               const auto&... results) { (*kept)(results...); };
  }

  std::unique_ptr<ByteStream> bytes_;
};

}  // namespace skein::console
