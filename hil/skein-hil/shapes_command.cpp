// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "commands.hpp"
#include "skein/configuration/shape_file.hpp"
#include "skein/formation/shapes.hpp"
#include "skein/groundstation/orders.hpp"
#include "skein/report/shapes.hpp"

namespace skein::hil {
namespace {

constexpr std::size_t kColumns = 4;
constexpr std::size_t kNamed = 5;  ///< vehicles that are drawn full

/// A shape by its name, or of a file.
Result<formation::ShapeSpec> shape_of(const std::string& name) {
  formation::ShapeSpec shape;
  if (const auto kind = groundstation::shape_named(name)) {
    shape.kind = *kind;
    return shape;
  }
  if (!name.ends_with(".yaml")) {
    return Error{fmt::format("there is no shape \"{}\"; name a file (.yaml), or one of: {}", name,
                             fmt::join(groundstation::shape_names(), ", "))};
  }
  const auto file = configuration::load_shape(name);
  if (!file) return file.error();
  shape.kind = formation::ShapeKind::free;
  shape.points = file->points;
  shape.closed = file->closed;
  return shape;
}

}  // namespace

int shapes(const ShapesArguments& arguments) {
  std::vector<report::ShapePanel> panels;
  for (const std::string& name : arguments.shapes) {
    auto shape = shape_of(name);
    if (!shape) return complain(shape.error().message);
    shape->spacing_m = arguments.spacing_m;
    for (const std::size_t vehicles : arguments.vehicles) {
      const auto places = formation::places(*shape, vehicles);
      if (!places) return complain(name + ": " + places.error().message);
      const std::string title = std::filesystem::path{name}.stem().string();
      panels.push_back({fmt::format("{}, {}", title, vehicles), *places, kNamed});
      if (!arguments.picture.empty()) continue;
      fmt::print("{}, {} vehicles\n{:>6} {:>9} {:>9} {:>9}\n", title, vehicles, "place", "dx m",
                 "dy m", "dz m");
      for (std::size_t i = 0; i < places->size(); ++i) {
        const Vec3& at = (*places)[i];
        fmt::print("{:>6} {:>9.2f} {:>9.2f} {:>9.2f}\n", i + 1, at.x(), at.y(), at.z());
      }
    }
  }
  if (arguments.picture.empty()) return kExitHeld;
  const std::string svg =
      report::shapes_svg(panels, arguments.spacing_m, std::min(kColumns, panels.size()));
  if (!(std::ofstream{arguments.picture, std::ios::binary} << svg).flush().good()) {
    return complain(arguments.picture.string() + ": cannot be written; check the path");
  }
  return kExitHeld;
}

}  // namespace skein::hil
