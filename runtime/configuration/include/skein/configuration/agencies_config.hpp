// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace skein::configuration {

/// Where Cursor on Target events go.
struct CotTarget {
  enum class Transport : std::uint8_t { udp, tcp, count };
  enum class Format : std::uint8_t { xml, protobuf, count };
  std::string address;  ///< IPv4; of a multicast too, by UDP
  std::uint16_t port = 0;
  Transport transport = Transport::udp;
  Format format = Format::xml;
  std::string interface;  ///< own address that a multicast leaves by; empty: by the routes
};

/// Where markers of others come in, to be proposed to the operator.
struct MarkersConfig {
  std::uint16_t port = 0;  ///< UDP; 0: none do
  std::string address = "127.0.0.1";
  std::string group;  ///< multicast that is joined; empty: none
};

/// Where MAVLink for watching goes.
struct MavlinkTarget {
  std::string address;  ///< IPv4
  std::uint16_t port = 14550;
};

/// A receiver of ADS-B (dump1090), which tells of aircraft that are not of the team.
struct AdsbConfig {
  std::string address;  ///< IPv4, where it tells SBS-1 text by TCP; empty: nowhere
  std::uint16_t port = 30003;
  std::string file;  ///< its aircraft.json, which it writes anew each second; empty: none
  /// What heights from pressure are corrected by: at the place, reduced to the sea's level.
  double qnh_hpa = 1013.25;
  double geoid_height_m = 0.0;  ///< of the geoid above the ellipsoid at the mission's origin
};

/// What systems of other agencies are shown, and what they may propose (docs/agencies.md).
struct AgenciesConfig {
  std::string team = "skein";  ///< begins callsigns and UIDs
  std::vector<CotTarget> cot;
  MarkersConfig markers;
  std::vector<MavlinkTarget> mavlink;
  AdsbConfig adsb;
};

}  // namespace skein::configuration
