// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/return_desk.hpp"

#include <fmt/format.h>

#include <string>

#include "skein/codec/json_text.hpp"
#include "skein/console/sections.hpp"

namespace skein::groundstation {
namespace {

using codec::Json;

std::string text_of(const mission::ReturnPreview& preview, Instant now) {
  std::string text = fmt::format("{} {} home", preview.ways.size(),
                                 preview.ways.size() == 1 ? "vehicle comes" : "vehicles come");
  if (!preview.ways.empty()) {
    text += fmt::format(", the last in {:.0f} s", to_seconds(preview.last_arrival - now));
  }
  if (preview.least_separation_m) {
    text += fmt::format(", least separation {:.0f} m", *preview.least_separation_m);
  }
  text += "\n";
  bool assumed = false;
  for (const auto& way : preview.ways) {
    assumed = assumed || way.home_assumed;
    text += fmt::format("vehicle {:<5} {:5.0f} m at height {:.0f} m, home in {:.0f} s{}\n",
                        way.vehicle.value, way.timed.path.length_m(), way.height_m,
                        to_seconds(way.timed.end_time() - now), way.home_assumed ? " *" : "");
  }
  for (const auto& [vehicle, why] : preview.cannot) {
    text += fmt::format("vehicle {:<5} has no planned way: it {}\n", vehicle.value, why);
  }
  if (assumed) text += "* home as where it was first heard: it tells where that is when ordered\n";
  return text;
}

std::string data_of(const mission::ReturnPreview& preview) {
  Json json{{"kind", "return_preview"},
            {"last_s", to_seconds(preview.last_arrival)},
            {"least_separation_m",
             preview.least_separation_m ? Json(*preview.least_separation_m) : Json(nullptr)},
            {"ways", Json::array()},
            {"cannot", Json::array()}};
  for (const auto& way : preview.ways) {
    Json one = codec::parse_own_json(console::path_json(way.vehicle, way.timed));
    one["z"] = way.height_m;
    one["length_m"] = way.timed.path.length_m();
    one["home_assumed"] = way.home_assumed;
    json["ways"].push_back(std::move(one));
  }
  for (const auto& [vehicle, why] : preview.cannot) {
    json["cannot"].push_back({{"id", vehicle.value}, {"why", why}});
  }
  return codec::json_text(json);
}

}  // namespace

Answer ReturnDesk::answer(const ReturnPreview& asked, Instant now) {
  if (shown_ && now - shown_->at < kShownFor) {
    if (shown_->vehicles == asked.vehicles) return shown_->answer;
    return {false, "other ways home have just been planned: ask again in a second\n"};
  }
  const auto preview = node_.preview_return(asked.vehicles, now);
  Answer answer = preview ? Answer{true, text_of(*preview, now), data_of(*preview)}
                          : Answer{false, preview.error().message + "\n"};
  shown_ = Shown{asked.vehicles, answer, now};
  return answer;
}

}  // namespace skein::groundstation
