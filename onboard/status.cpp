// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/status.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "skein/codec/json_text.hpp"

namespace skein::onboard {
namespace {

using codec::Json;

constexpr double kMega = 1e6;

double seconds(std::chrono::nanoseconds d) { return std::chrono::duration<double>(d).count(); }

Json recording_json(const Status::Recording& recording) {
  Json json{{"folder", recording.folder},
            {"bytes", recording.bytes},
            {"bytes_per_s", recording.bytes_per_s},
            {"free_bytes", nullptr}};
  if (recording.free_bytes) json["free_bytes"] = *recording.free_bytes;
  return json;
}

std::string clock_text(const codec::ParsedJson& clock) {
  if (clock.is_null()) return "the kernel does not say";
  if (!clock.at("synchronised").get<bool>()) return "not synchronised";
  return fmt::format("synchronised to {:.3f} s", clock.at("error_max_s").get<double>());
}

std::string recording_text(const codec::ParsedJson& recording) {
  if (recording.is_null()) return "none";
  std::string text = fmt::format(
      "{}, {:.1f} MB, {:.1f} kB/s", recording.at("folder").get<std::string>(),
      recording.at("bytes").get<double>() / kMega, recording.at("bytes_per_s").get<double>() / 1e3);
  const auto& free = recording.at("free_bytes");
  if (!free.is_null()) text.append(fmt::format("; {:.0f} MB free", free.get<double>() / kMega));
  return text;
}

std::string text_of(const codec::ParsedJson& json) {
  const auto& airborne = json.at("flying");
  std::string text =
      fmt::format("vehicle     {}, {}\nflying      {}\nmode        {}\nmission     {:.1f} s\n",
                  json.at("vehicle").get<unsigned>(), json.at("program").get<std::string>(),
                  airborne.is_null() ? "not known" : (airborne.get<bool>() ? "yes" : "no"),
                  json.at("mode").get<std::string>(), json.at("mission_time_s").get<double>());
  text.append("clock       ").append(clock_text(json.at("clock"))).append("\n");
  text.append("recording   ").append(recording_text(json.at("recording"))).append("\n");
  const auto& watchdog = json.at("watchdog");
  text.append(fmt::format("progress    control {:.1f} s ago, agent {:.1f} s ago{}\n",
                          watchdog.at("control_age_s").get<double>(),
                          watchdog.at("agent_age_s").get<double>(),
                          watchdog.at("watched").get<bool>() ? ", watched" : ", not watched"));
  text.append(fmt::format("network     started again {} times\n",
                          json.at("network_restarts").get<std::uint64_t>()));
  text.append("hears      ");
  for (const auto& other : json.at("heard")) {
    text.append(fmt::format(" {} ({:.1f} s)", other.at("vehicle").get<unsigned>(),
                            other.at("age_s").get<double>()));
  }
  text.append("\n");
  for (const auto& problem : json.at("problems")) {
    text.append("problem     ").append(problem.get<std::string>()).append("\n");
  }
  return text;
}

}  // namespace

mission::Health HealthBoard::with_host(mission::Health health) const {
  const std::lock_guard lock{mutex_};
  for (std::string& problem : mission::host_problems(host_)) {
    if (health.problems.size() >= mission::kProblemsMax) break;
    health.problems.push_back(std::move(problem));
  }
  return health;
}

mission::Health with_receptions(mission::Health health,
                                const std::vector<network::Reception>& receptions) {
  for (mission::Heard& heard : health.heard) {
    const auto counted = std::ranges::find(receptions, heard.vehicle, &network::Reception::sender);
    if (counted == receptions.end()) continue;
    heard.datagrams = counted->datagrams;
    heard.lost_percent = counted->lost_percent;
  }
  return health;
}

std::string status_json(const Status& status) {
  const mission::Health& health = status.health;
  Json json{{"vehicle", health.vehicle.value},
            {"program", health.program},
            {"instance", fmt::format("{:016x}", health.instance.value)},
            {"mission_time_s", to_seconds(status.now)},
            {"flying", nullptr},
            {"flight_controller", health.flight_controller},
            {"mode", health.mode},
            {"problems", health.problems},
            {"heard", Json::array()},
            {"clock", nullptr},
            {"recording", nullptr},
            {"overruns", status.overruns},
            {"stale_states", status.stale_states},
            {"network_restarts", status.network_restarts},
            {"watchdog",
             {{"watched", status.watched},
              {"control_age_s", seconds(status.control_age)},
              {"agent_age_s", seconds(status.agent_age)}}}};
  if (status.airborne != hal::Airborne::unknown) {
    json["flying"] = status.airborne == hal::Airborne::yes;
  }
  for (const auto& other : health.heard) {
    json["heard"].push_back({{"vehicle", other.vehicle.value}, {"age_s", seconds(other.age)}});
  }
  if (status.clock) {
    json["clock"] = {{"synchronised", status.clock->synchronised},
                     {"error_max_s", seconds(status.clock->error_max)}};
  }
  if (status.recording) json["recording"] = recording_json(*status.recording);
  return codec::json_text(json);
}

Result<std::string> status_text(const std::string& json) {
  const auto parsed = codec::parse_json(json);
  try {
    return text_of(parsed);
  } catch (const codec::ParsedJson::exception& broken) {
    return Error{fmt::format("what it answers is no status of this release: {}", broken.what())};
  }
}

hal::Airborne airborne_in(const std::string& json) {
  const auto parsed = codec::parse_json(json);
  if (!parsed.is_object() || !parsed.contains("flying") || !parsed["flying"].is_boolean()) {
    return hal::Airborne::unknown;
  }
  return parsed["flying"].get<bool>() ? hal::Airborne::yes : hal::Airborne::no;
}

}  // namespace skein::onboard
