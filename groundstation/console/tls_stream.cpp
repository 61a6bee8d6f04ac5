// SPDX-License-Identifier: Apache-2.0
#include <boost/beast/ssl.hpp>

#include "stream_over.hpp"

namespace skein::console {

std::unique_ptr<HttpStream> open_tls_stream(boost::asio::ip::tcp::socket socket,
                                            boost::asio::ssl::context& tls) {
  using Tls = boost::beast::ssl_stream<boost::beast::tcp_stream>;
  return std::make_unique<HttpStreamOver<Tls>>(
      Tls{boost::beast::tcp_stream{std::move(socket)}, tls});
}

}  // namespace skein::console
