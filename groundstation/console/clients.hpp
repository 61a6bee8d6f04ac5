// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "hub.hpp"
#include "stream.hpp"

/// The three that speak with a connection; each lives as long as it does.

namespace skein::console {

inline constexpr std::string_view kPageProtocol = "skein.console.1";

/// HTTP with that address, until it asks for a socket; `local`: with this machine.
void serve_http(Hub& hub, std::unique_ptr<HttpStream> stream, std::string address, bool local);
/// The page's socket, of who sent these cookies.
void serve_page(Hub& hub, std::unique_ptr<WebSocket> socket, const Identity& identity,
                std::string cookies, std::shared_ptr<Connections::Place> place);
/// Foxglove's, with one of kFoxgloveProtocols.
void serve_foxglove(Hub& hub, std::unique_ptr<WebSocket> socket, std::string_view protocol,
                    std::string cookies, std::shared_ptr<Connections::Place> place);

}  // namespace skein::console
