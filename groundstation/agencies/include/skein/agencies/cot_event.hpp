// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/frames.hpp"

namespace skein::agencies {

/// One event of Cursor on Target 2.0 (MITRE MTR090284, "Cursor on Target Message Router User's
/// Guide"; details as the TAK programs have them). Text is UTF-8.
struct CotEvent {
  std::string uid;   ///< of what it tells of, in all of its events
  std::string type;  ///< "a-f-A-M-F-Q"
  std::string how;   ///< it is known: "m-g", by its own navigation
  std::int64_t time_unix_ns = 0;
  std::int64_t stale_unix_ns = 0;  ///< from then on it tells nothing; not after `time`: it is ended
  Wgs84 place;
  std::string callsign;
  std::string remarks;
  struct Track {
    double course_deg = 0.0;  ///< over the ground, from true north
    double speed_mps = 0.0;
  };
  std::optional<Track> track{};
  std::optional<std::uint32_t> battery_percent{};
  std::optional<double> radius_m{};  ///< of a circle around `place`
  std::vector<Wgs84> line{};
  std::optional<std::uint32_t> colour_argb{};  ///< of a marker, a circle or a line

  friend bool operator==(const CotEvent& a, const CotEvent& b);
};

/// As an XML document, without line ends.
[[nodiscard]] std::string to_xml(const CotEvent& event);
/// A datagram of TAK's protocol version 1 for meshes: its header and a TakMessage
/// (https://github.com/deptofdefense/AndroidTacticalAssaultKit-CIV, takproto).
[[nodiscard]] std::string to_protobuf(const CotEvent& event);

}  // namespace skein::agencies
