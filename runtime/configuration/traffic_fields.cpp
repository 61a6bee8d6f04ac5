// SPDX-License-Identifier: Apache-2.0
#include "process_fields.hpp"
#include "skein/configuration/scenario.hpp"

namespace skein::configuration {

void traffic_fields(FieldVisitor& v, TrafficParams& p) {
  v.number({"horizontal_m",
            "a vehicle that will be closer than this to an aircraft that is not of the team, and "
            "less than vertical_m in height, gives way by its height"},
           {50.0, 20'000.0, "m"}, p.horizontal_m);
  v.number({"vertical_m", "and keeps this much apart in height"}, {20.0, 2000.0, "m"},
           p.vertical_m);
  seconds(v, {"look_ahead_s", "so far ahead that is looked at; 0: it is not"}, {0.0, 300.0, "s"},
          p.look_ahead);
  v.number({"floor_m", "above the origin: nobody gives way downwards to less"}, {0.0, 10000.0, "m"},
           p.floor_m);
  v.number({"ceiling_m", "nobody gives way upwards to more, nor above fence.height_max_m"},
           {1.0, 20000.0, "m"}, p.ceiling_m);
  v.require(p.floor_m < p.ceiling_m, "ceiling_m", "must be above floor_m; mend one of them");
}

void traffic_section(FieldVisitor& v, TrafficParams& params) {
  v.section({"traffic",
             "how vehicles keep clear of aircraft that are not of the team; the same for the whole "
             "fleet"},
            [&params](FieldVisitor& inner) { traffic_fields(inner, params); });
}

void passing_aircraft_list(FieldVisitor& v, std::vector<PassingAircraft>& aircraft) {
  const auto group = [](FieldVisitor& inner, PassingAircraft& one) {
    whole(inner, {"address", "of ICAO, 24 bits", kRequired}, {1.0, 16'777'215.0}, one.address);
    inner.point({"from", "east and north where it is first heard", kRequired}, kMetres, one.from_m);
    inner.point({"to", "where it is last heard", kRequired}, kMetres, one.to_m);
    inner.number({"height_m", "above the origin", kRequired}, kMetres, one.height_m);
    inner.number({"climb_mps", "upwards"}, {-100.0, 100.0, "m/s"}, one.climb_mps);
    inner.number({"speed_mps", "over the ground", kRequired}, {1.0, 700.0, "m/s"}, one.speed_mps);
    seconds(inner, {"at_s", "mission time when it is first heard"}, kSeconds, one.at);
  };
  v.list({"aircraft",
          "in a mission in virtual time: what is not of the team and flies past it, as a receiver "
          "at the ground station hears it"},
         unique_groups_of(aircraft, kListMax, group, "aircraft",
                          [](const PassingAircraft& one) { return one.address; }));
}

}  // namespace skein::configuration
