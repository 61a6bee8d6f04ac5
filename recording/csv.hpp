// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "skein/base/result.hpp"

/// The few rules of RFC 4180 that the recording needs. A record never spans lines.
namespace skein::recording {

inline constexpr std::string_view kTrackHeader =
    "time_s,x_m,y_m,z_m,heading_rad,course_rad,groundspeed_mps,airspeed_mps,distance_flown_m,"
    "plan_number,along_error_m,cross_error_m";
inline constexpr std::string_view kEventsHeader =
    "time_ns,vehicle,kind,leader,instance,coalition,round,site,task,index,value,text";
inline constexpr std::string_view kPlansHeader =
    "plan_number,since_ns,start_time_ns,speed_mps,tail_curvature_per_m,x_m,y_m,heading_rad,"
    "segments";

inline constexpr std::string_view kPlacesHeader = "change,start_ns,vehicle,x_m,y_m,z_m";

/// The shortest decimal that reads back as the same double.
void append_exact(std::string& line, double value);
void append_fixed(std::string& line, double value, int decimals);
void append_integer(std::string& line, std::int64_t value);
void append_unsigned(std::string& line, std::uint64_t value);
/// Quoted; control characters become spaces.
void append_quoted(std::string& line, std::string_view text);

/// The fields of one line, unquoted. Fails on a quote that does not close.
[[nodiscard]] Result<std::vector<std::string>> split(std::string_view line);

/// The whole field as a number of type T. Not finite counts as no number.
template <class T>
[[nodiscard]] bool parse_number(std::string_view field, T& value) {
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc{} || end != field.data() + field.size()) return false;
  if constexpr (std::is_floating_point_v<T>) return std::isfinite(value);
  return true;
}

}  // namespace skein::recording
