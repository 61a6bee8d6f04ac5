// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "skein/base/result.hpp"

struct sqlite3;

namespace skein::console {

/// Map tiles (web mercator) of a folder z/x/y.png (or .jpg, .webp), or of an MBTiles file
/// (github.com/mapbox/mbtiles-spec, 1.3). For one thread.
class Tiles {
 public:
  /// Fails where there is no such folder or file, or the file is no MBTiles.
  [[nodiscard]] static Result<Tiles> open(const std::string& path);

  struct Tile {
    std::string bytes;
    std::string type;  ///< MIME
  };
  [[nodiscard]] std::optional<Tile> tile(unsigned zoom, unsigned x, unsigned y) const;
  /// The `tiles` of a hello message: a JSON object.
  [[nodiscard]] std::string description() const;

 private:
  struct Close {
    void operator()(sqlite3* file) const;
  };
  Tiles() = default;
  Result<void> open_folder();
  Result<void> open_file();

  std::string path_;
  std::unique_ptr<sqlite3, Close> file_;  ///< none: a folder
  std::string type_;
  unsigned min_zoom_ = 0;
  unsigned max_zoom_ = 22;
  std::string attribution_;
};

}  // namespace skein::console
