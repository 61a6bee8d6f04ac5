// SPDX-License-Identifier: Apache-2.0
#include "tiles.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "skein/codec/json_text.hpp"

namespace skein::console {
namespace {

constexpr std::array<std::pair<const char*, const char*>, 4> kTypes{
    {{"png", "image/png"}, {"jpg", "image/jpeg"}, {"jpeg", "image/jpeg"}, {"webp", "image/webp"}}};
constexpr unsigned kZoomMax = 24;

struct Finalize {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Statement = std::unique_ptr<sqlite3_stmt, Finalize>;

Statement prepare(sqlite3* file, const char* sql) {
  sqlite3_stmt* statement = nullptr;
  sqlite3_prepare_v2(file, sql, -1, &statement, nullptr);
  return Statement{statement};
}

std::string column_bytes(sqlite3_stmt* row) {
  const void* bytes = sqlite3_column_blob(row, 0);
  const int size = sqlite3_column_bytes(row, 0);
  if (bytes == nullptr || size <= 0) return {};
  return {static_cast<const char*>(bytes), static_cast<std::size_t>(size)};
}

std::string metadata(sqlite3* file, const char* name) {
  const Statement statement = prepare(file, "SELECT value FROM metadata WHERE name = ?1");
  if (!statement) return {};
  sqlite3_bind_text(statement.get(), 1, name, -1, SQLITE_STATIC);
  return sqlite3_step(statement.get()) == SQLITE_ROW ? column_bytes(statement.get()) : "";
}

std::optional<unsigned> whole(std::string_view text) {
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

void Tiles::Close::operator()(sqlite3* file) const { sqlite3_close(file); }

Result<Tiles> Tiles::open(const std::string& path) {
  Tiles tiles;
  tiles.path_ = path;
  const bool folder = std::filesystem::is_directory(path);
  if (const auto opened = folder ? tiles.open_folder() : tiles.open_file(); !opened) {
    return opened.error();
  }
  return tiles;
}

Result<void> Tiles::open_folder() {
  std::optional<unsigned> least;
  unsigned greatest = 0;
  for (const auto& entry : std::filesystem::directory_iterator{path_}) {
    const auto zoom = whole(entry.path().filename().string());
    if (!zoom || *zoom > kZoomMax || !entry.is_directory()) continue;
    least = std::min(least.value_or(*zoom), *zoom);
    greatest = std::max(greatest, *zoom);
  }
  if (!least) return Error{path_ + ": a folder of tiles has folders 0, 1, 2... of zoom levels"};
  min_zoom_ = *least;
  max_zoom_ = greatest;
  return {};
}

Result<void> Tiles::open_file() {
  sqlite3* file = nullptr;
  const int status = sqlite3_open_v2(path_.c_str(), &file, SQLITE_OPEN_READONLY, nullptr);
  file_.reset(file);
  if (status != SQLITE_OK || !prepare(file, "SELECT tile_data FROM tiles LIMIT 1")) {
    return Error{path_ + ": neither a folder of tiles nor an MBTiles file"};
  }
  const std::string format = metadata(file, "format");
  const auto known = std::find_if(kTypes.begin(), kTypes.end(),
                                  [&](const auto& type) { return format == type.first; });
  if (known == kTypes.end()) {
    return Error{path_ + ": its tiles are '" + format +
                 "'; the console shows pictures: png, jpg or webp"};
  }
  type_ = known->second;
  min_zoom_ = whole(metadata(file, "minzoom")).value_or(0);
  max_zoom_ = std::min(whole(metadata(file, "maxzoom")).value_or(kZoomMax), kZoomMax);
  attribution_ = metadata(file, "attribution");
  return {};
}

std::optional<Tiles::Tile> Tiles::tile(unsigned zoom, unsigned x, unsigned y) const {
  if (zoom > kZoomMax || x >= (1U << zoom) || y >= (1U << zoom)) return std::nullopt;
  if (file_) {
    const Statement statement = prepare(
        file_.get(),
        "SELECT tile_data FROM tiles WHERE zoom_level = ?1 AND tile_column = ?2 AND tile_row = ?3");
    if (!statement) return std::nullopt;
    sqlite3_bind_int64(statement.get(), 1, zoom);
    sqlite3_bind_int64(statement.get(), 2, x);
    sqlite3_bind_int64(statement.get(), 3, (1U << zoom) - 1U - y);  // its rows count from the south
    if (sqlite3_step(statement.get()) != SQLITE_ROW) return std::nullopt;
    return Tile{column_bytes(statement.get()), type_};
  }
  const std::filesystem::path stem =
      std::filesystem::path{path_} / std::to_string(zoom) / std::to_string(x) / std::to_string(y);
  for (const auto& [extension, type] : kTypes) {
    std::ifstream stream{stem.string() + "." + extension, std::ios::binary};
    if (stream) return Tile{{std::istreambuf_iterator<char>{stream}, {}}, type};
  }
  return std::nullopt;
}

std::string Tiles::description() const {
  return codec::json_text({{"url", "/tiles/{z}/{x}/{y}"},
                           {"min_zoom", min_zoom_},
                           {"max_zoom", max_zoom_},
                           {"attribution", attribution_}});
}

}  // namespace skein::console
