// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "server_impl.hpp"
#include "stream.hpp"

/// The three that speak with a connection; each lives as long as it does.

namespace skein::console {

inline constexpr std::string_view kPageProtocol = "skein.console.1";

/// HTTP, until it asks for a socket.
void serve_http(Server::Impl& server, std::unique_ptr<HttpStream> stream);
/// The page's socket.
void serve_page(Server::Impl& server, std::unique_ptr<WebSocket> socket, const Identity& identity,
                std::shared_ptr<Server::Impl::Place> place, const HttpRequest& request);
/// Foxglove's, with one of kFoxgloveProtocols.
void serve_foxglove(Server::Impl& server, std::unique_ptr<WebSocket> socket,
                    std::string_view protocol, std::shared_ptr<Server::Impl::Place> place,
                    const HttpRequest& request);

}  // namespace skein::console
