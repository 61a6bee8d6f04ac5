// SPDX-License-Identifier: Apache-2.0
#include "skein/recording_export/recording_export.hpp"

#include <fstream>
#include <system_error>

#include "csv.hpp"
#include "flights.hpp"

namespace skein::recording_export {
namespace {

/// Writes files into a folder and remembers their names, and the first that could not be written.
class Folder {
 public:
  explicit Folder(std::filesystem::path path) : path_{std::move(path)} {}

  void write(const std::string& name, const std::string& text) {
    const auto file = path_ / name;
    std::error_code failure;
    std::filesystem::create_directories(file.parent_path(), failure);
    std::ofstream out{file, std::ios::binary};
    out << text;
    if (!out.flush() && failed_.empty()) failed_ = file.string();
    names_.push_back(name);
  }
  [[nodiscard]] Result<std::vector<std::string>> names() const {
    if (!failed_.empty()) return Error{"cannot write " + failed_ + "; choose another folder"};
    return names_;
  }

 private:
  std::filesystem::path path_;
  std::vector<std::string> names_;
  std::string failed_;
};

}  // namespace

Result<Written> write(const std::filesystem::path& path, Format format,
                      const std::filesystem::path& folder) {
  const auto flights = read_flights(path);
  if (!flights) return flights.error();
  if (flights->by_node.empty()) {
    return Error{path.string() + ": no track, event, plan or place can be read from it; " +
                 "skein-ground info tells what is there"};
  }
  Folder files{folder};
  const auto written = [&]() -> Result<Written> {
    auto names = files.names();
    if (!names) return names.error();
    return Written{*std::move(names), flights->damaged, flights->complete};
  };
  if (format == Format::csv) {
    for (const auto& [node, flight] : flights->by_node) {
      const std::string name = recording::folder_name(node) + "/";
      files.write(name + "events.csv", events_csv(flight));
      if (!flight.track.empty()) files.write(name + "track.csv", track_csv(flight));
      if (!flight.plans.empty()) files.write(name + "plans.csv", plans_csv(flight));
      if (!flight.places.empty()) files.write(name + "places.csv", places_csv(flight));
    }
    return written();
  }
  const auto text = format == Format::geojson ? geojson(*flights) : kml(*flights);
  if (!text) return text.error();
  files.write(format == Format::geojson ? "flight.geojson" : "flight.kml", *text);
  return written();
}

}  // namespace skein::recording_export
