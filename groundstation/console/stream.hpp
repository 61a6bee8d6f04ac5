// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "http.hpp"

namespace skein::console {

/// A WebSocket on some stream. One read and one write at a time; handlers keep it alive, and are
/// called by the thread of the socket's context.
class WebSocket {
 public:
  struct Text {
    bool binary = false;
    std::string bytes;
  };

  WebSocket() = default;
  virtual ~WebSocket() = default;
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;

  /// Answers the request for it, with that subprotocol; what is longer than `read_max` ends it.
  virtual void accept(std::string_view subprotocol, std::size_t read_max,
                      std::function<void(bool ok)> done) = 0;
  /// Nothing where it has ended.
  virtual void read(std::function<void(std::optional<Text>)> done) = 0;
  /// `bytes` must stay until it is done.
  virtual void write(std::string_view bytes, bool binary, std::function<void(bool ok)> done) = 0;
  /// Says that the client broke a rule. No write may be going on.
  virtual void close_for_policy(std::function<void()> done) = 0;
  /// Ends it without a word.
  virtual void drop() = 0;
};

/// HTTP on some stream, each step within kPatience. Handlers as with WebSocket.
class HttpStream {
 public:
  HttpStream() = default;
  virtual ~HttpStream() = default;
  HttpStream(const HttpStream&) = delete;
  HttpStream& operator=(const HttpStream&) = delete;

  virtual void handshake(std::function<void(bool ok)> done) = 0;
  /// Nothing where no request came, or none within the limits.
  virtual void read(std::function<void(std::optional<HttpRequest>)> done) = 0;
  /// Answers what was read last; false where nothing more may follow.
  virtual void write(HttpResponse response, std::function<void(bool more)> done) = 0;
  /// Its stream, from now on for the WebSocket that was asked for last.
  [[nodiscard]] virtual std::unique_ptr<WebSocket> upgrade() = 0;
  /// What was sent still arrives.
  virtual void close() = 0;
  /// Ends it without a word.
  virtual void drop() = 0;
};

class ByteStream;
/// `secure`: it is TLS, and browsers shall come by that only.
[[nodiscard]] std::unique_ptr<HttpStream> open_http(std::unique_ptr<ByteStream> bytes, bool secure);

}  // namespace skein::console
