// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "skein/recording/recording.hpp"

/// Each with a header line, a line a record, texts in quotes (RFC 4180).
namespace skein::recording_export {

[[nodiscard]] std::string track_csv(const recording::Recording& flight);
[[nodiscard]] std::string events_csv(const recording::Recording& flight);
/// segments: curvature_per_m:length_m|...
[[nodiscard]] std::string plans_csv(const recording::Recording& flight);
[[nodiscard]] std::string places_csv(const recording::Recording& flight);

}  // namespace skein::recording_export
