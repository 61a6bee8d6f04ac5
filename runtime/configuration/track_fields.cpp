// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "process_fields.hpp"
#include "skein/configuration/track_file.hpp"

namespace skein::configuration {
namespace {

constexpr std::array<std::string_view, 2> kOutlines{"closed", "open"};

}  // namespace

void fields(FieldVisitor& v, TrackFile& file) {
  version_field(v);
  v.text({"title", "one line", kRequired}, file.title);
  v.text({"notes", "where the track is from"}, file.notes);
  std::size_t outline = file.track.closed ? 0 : 1;
  v.choice({"outline",
            "closed: a lap, from the middle of the leg between the first two waypoints back to "
            "there; open: from the first waypoint to the last"},
           kOutlines, outline);
  file.track.closed = outline == 0;
  v.number({"turn_radius_m", "of the arcs at waypoints, and of the orbit at the end"},
           {1.0, 20000.0, "m"}, file.track.turn_radius_m);
  List points = list_of(file.track.waypoints, kListMax,
                        [](FieldVisitor& inner, Vec2& point) { inner.point({}, kMetres, point); });
  v.list({"waypoints", "[east, north] of the origin, in their order", kRequired}, points);
  v.require(file.track.waypoints.size() >= (file.track.closed ? 3U : 2U), "waypoints",
            "are too few; a closed track needs three, an open one two");
}

}  // namespace skein::configuration
