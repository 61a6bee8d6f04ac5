// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace skein::console {

enum class HttpMethod { get, head, post, remove, other };

/// What our pages ask of a request, of any HTTP library.
struct HttpRequest {
  HttpMethod method = HttpMethod::get;
  std::string target;
  std::string host;  ///< fields that are missing are empty
  std::string origin;
  std::string cookie;
  std::string body;
  bool wants_socket = false;
  bool local = false;                     ///< from this machine
  std::vector<std::string> subprotocols;  ///< that the socket may speak
};

enum class HttpStatus {
  ok = 200,
  bad_request = 400,
  unauthorized = 401,
  forbidden = 403,
  not_found = 404,
  method_not_allowed = 405,
  misdirected_request = 421,
  too_many_requests = 429,
  service_unavailable = 503,
};

/// With it go the header fields that every answer of ours has: no page, script or style from
/// elsewhere, no framing, no guessing of types, and nothing kept unless a field says so.
struct HttpResponse {
  HttpStatus status = HttpStatus::ok;
  std::string type;  ///< of the media
  std::string body;
  std::vector<std::pair<std::string_view, std::string>> fields = {};  ///< names: literals
  bool last = false;  ///< the connection ends with it
};

namespace media {
inline constexpr const char* kJson = "application/json";
inline constexpr const char* kText = "text/plain; charset=utf-8";
}  // namespace media

}  // namespace skein::console
