// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "process_fields.hpp"
#include "skein/configuration/shape_file.hpp"

namespace skein::configuration {
namespace {

constexpr std::size_t kPointsMax = 1000;
constexpr std::array<std::string_view, 2> kOutlines{"closed", "open"};

void point_fields(FieldVisitor& v, Vec3& point) {
  v.number({"dx_m", "along track, forward", kRequired}, kMetres, point.x());
  v.number({"dy_m", "across track, to the left", kRequired}, kMetres, point.y());
  v.number({"dz_m", "height, up"}, kMetres, point.z());
}

}  // namespace

void fields(FieldVisitor& v, ShapeFile& shape) {
  version_field(v);
  v.text({"title", "one line", kRequired}, shape.title);
  v.text({"notes", "where the shape is from"}, shape.notes);
  std::size_t outline = shape.closed ? 0 : 1;
  v.choice({"outline", "whether it leads back from the last point to the first"}, kOutlines,
           outline);
  shape.closed = outline == 0;
  // A new point is of zeros: Eigen leaves its numbers as memory had them.
  List points = groups_of(shape.points, kPointsMax, point_fields);
  points.resize = [&shape](std::size_t n) { shape.points.resize(n, Vec3::Zero()); };
  v.list({"points", "in the order of the outline", kRequired}, points);
  v.require(!shape.points.empty(), "points", "is empty; give it one point at least");
}

}  // namespace skein::configuration
