// SPDX-License-Identifier: Apache-2.0
#include "stream_over.hpp"

namespace skein::console {

std::unique_ptr<HttpStream> open_plain_stream(boost::asio::ip::tcp::socket socket) {
  using Plain = boost::beast::tcp_stream;
  return std::make_unique<HttpStreamOver<Plain>>(Plain{std::move(socket)});
}

}  // namespace skein::console
