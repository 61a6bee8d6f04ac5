// SPDX-License-Identifier: Apache-2.0
#include "byte_stream.hpp"

#include <boost/asio/ssl/stream_base.hpp>
#include <boost/beast/core/stream_traits.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <boost/beast/websocket/teardown.hpp>
#include <type_traits>

namespace skein::console {
namespace {

namespace beast = boost::beast;
using Plain = beast::tcp_stream;
using Tls = beast::ssl_stream<beast::tcp_stream>;

template <class Stream>
class ByteStreamOver final : public ByteStream {
 public:
  template <class... Arguments>
  explicit ByteStreamOver(Arguments&&... arguments)
      : stream_{std::forward<Arguments>(arguments)...} {}

  [[nodiscard]] boost::asio::any_io_executor executor() override { return stream_.get_executor(); }

  void handshake(std::function<void(beast::error_code)> done) override {
    if constexpr (std::is_same_v<Stream, Tls>) {
      stream_.async_handshake(boost::asio::ssl::stream_base::server, std::move(done));
    } else {
      done({});
    }
  }
  void read_some(std::vector<boost::asio::mutable_buffer> buffers, Done done) override {
    stream_.async_read_some(buffers, std::move(done));
  }
  void write_some(std::vector<boost::asio::const_buffer> buffers, Done done) override {
    stream_.async_write_some(buffers, std::move(done));
  }
  void shut_down(beast::role_type role, std::function<void(beast::error_code)> done) override {
    async_teardown(role, stream_, std::move(done));
  }
  void expire_after(std::chrono::seconds limit) override { connection().expires_after(limit); }
  void never_expire() override { connection().expires_never(); }
  void end_sending() override {
    beast::error_code ignored;
    connection().socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
  }
  void close() override { connection().close(); }

 private:
  [[nodiscard]] beast::tcp_stream& connection() { return beast::get_lowest_layer(stream_); }

  Stream stream_;
};

}  // namespace

std::unique_ptr<ByteStream> open_plain(boost::asio::ip::tcp::socket socket) {
  return std::make_unique<ByteStreamOver<Plain>>(std::move(socket));
}

std::unique_ptr<ByteStream> open_tls(boost::asio::ip::tcp::socket socket,
                                     boost::asio::ssl::context& tls) {
  return std::make_unique<ByteStreamOver<Tls>>(beast::tcp_stream{std::move(socket)}, tls);
}

}  // namespace skein::console
