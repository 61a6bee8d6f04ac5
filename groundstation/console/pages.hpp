// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gate.hpp"
#include "http.hpp"
#include "skein/console/server.hpp"
#include "tiles.hpp"

namespace skein::console {

/// What is got over HTTP: the page, map tiles, overlays, and who one is. Everything but the socket
/// and the login.
class Pages {
 public:
  /// Overlays are read now. `gate` must outlive this.
  [[nodiscard]] static Result<Pages> open(const ServerConfig& config, const Gate& gate);

  [[nodiscard]] HttpResponse respond(const HttpRequest& request) const;
  [[nodiscard]] const std::optional<Tiles>& tiles() const { return tiles_; }

 private:
  explicit Pages(const Gate& gate) : gate_{&gate} {}
  [[nodiscard]] std::optional<HttpResponse> tile(std::string_view path) const;

  const Gate* gate_;
  std::optional<Tiles> tiles_;
  struct Loaded {
    std::string path;
    std::string text;
  };
  std::vector<Loaded> overlays_;
};

}  // namespace skein::console
