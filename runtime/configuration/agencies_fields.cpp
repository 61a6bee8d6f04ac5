// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "process_fields.hpp"
#include "skein/configuration/agencies_config.hpp"

namespace skein::configuration {
namespace {

constexpr std::size_t kTargetsMax = 8;
constexpr std::size_t kTeamNameMax = 32;
constexpr Range kUdpPort{1.0, 65535.0};
constexpr std::array<std::string_view, 2> kTransports{"udp", "tcp"};
constexpr std::array<std::string_view, 2> kFormats{"xml", "protobuf"};
constexpr std::string_view kNoAddress = "is no IPv4 address; write one such as 192.168.1.7";

/// The first byte of an IPv4 address; none of what is no address.
std::optional<unsigned> first_byte(const std::string& text) {
  in_addr parsed{};
  if (inet_pton(AF_INET, text.c_str(), &parsed) != 1) return std::nullopt;
  return ntohl(parsed.s_addr) >> 24U;
}

bool is_multicast(const std::string& text) { return first_byte(text).value_or(0) >> 4U == 14; }

bool is_team_name(const std::string& name) {
  return !name.empty() && name.size() <= kTeamNameMax &&
         std::ranges::all_of(
             name, [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_'; });
}

void cot_fields(FieldVisitor& v, CotTarget& target) {
  v.text({"address", "IPv4: of a machine, or by UDP of a multicast (TAK's own is 239.2.3.1)",
          kRequired},
         target.address);
  v.require(first_byte(target.address).value_or(0) != 0, "address", kNoAddress);
  whole(v, {"port", "TAK's multicast has 6969, its servers 8087 (TCP)", kRequired}, kUdpPort,
        target.port);
  auto transport = static_cast<std::size_t>(target.transport);
  v.choice({"transport", "an event a datagram; or a connection that is made again when it ends"},
           kTransports, transport);
  target.transport = static_cast<CotTarget::Transport>(transport);
  v.require(target.transport == CotTarget::Transport::udp || !is_multicast(target.address),
            "transport", "has to be udp to a multicast");
  auto format = static_cast<std::size_t>(target.format);
  v.choice({"format", "Cursor on Target 2.0; or TAK's protocol version 1 for meshes, by UDP"},
           kFormats, format);
  target.format = static_cast<CotTarget::Format>(format);
  v.require(
      target.transport == CotTarget::Transport::udp || target.format == CotTarget::Format::xml,
      "format", "has to be xml by tcp");
  v.text({"interface", "this machine's address that a multicast leaves by; empty: by its routes"},
         target.interface);
  v.require(target.interface.empty() || first_byte(target.interface), "interface", kNoAddress);
}

void markers_fields(FieldVisitor& v, MarkersConfig& config) {
  whole(v, {"port", "UDP, where markers come in as Cursor on Target XML; 0: none do"},
        {0.0, 65535.0}, config.port);
  v.text({"address", "this machine's, where they are taken; 0.0.0.0: all of its"}, config.address);
  v.require(first_byte(config.address).has_value(), "address", kNoAddress);
  v.text({"group", "multicast that is joined by that address; empty: none"}, config.group);
  v.require(config.group.empty() || is_multicast(config.group), "group",
            "is no multicast; write one such as 239.2.3.1");
}

void mavlink_fields(FieldVisitor& v, MavlinkTarget& target) {
  v.text({"address", "IPv4", kRequired}, target.address);
  v.require(first_byte(target.address).value_or(0) != 0, "address", kNoAddress);
  whole(v, {"port", "UDP"}, kUdpPort, target.port);
}

void adsb_fields(FieldVisitor& v, AdsbConfig& config) {
  v.text({"address", "IPv4 of a dump1090 that tells SBS-1 text by TCP; empty: none"},
         config.address);
  v.require(config.address.empty() || first_byte(config.address), "address", kNoAddress);
  whole(v, {"port", "TCP, of that text"}, kUdpPort, config.port);
  v.text({"file", "path of dump1090's aircraft.json on this machine; empty: none"}, config.file);
  v.require(config.address.empty() || config.file.empty(), "file",
            "is read in place of an address; give one of them");
  v.number({"qnh_hpa",
            "pressure at the place, reduced to the sea's level: what heights from pressure are "
            "corrected by; 27 ft for each hPa"},
           {900.0, 1100.0, "hPa"}, config.qnh_hpa);
  v.number({"geoid_height_m",
            "of the geoid above the ellipsoid at the origin: heights from pressure count from it"},
           {-120.0, 100.0, "m"}, config.geoid_height_m);
}

}  // namespace

void agencies_section(FieldVisitor& v, AgenciesConfig& config) {
  v.section({"agencies", "systems of other agencies that see the team (docs/agencies.md)"},
            [&config](FieldVisitor& inner) {
              inner.text({"team",
                          "its name, which begins what others call its vehicles; of "
                          "letters, digits, - and _"},
                         config.team);
              inner.require(is_team_name(config.team), "team",
                            "may have 1 to 32 letters, digits, - and _ only");
              inner.list({"cot", "where Cursor on Target events go, for TAK; none: nowhere"},
                         groups_of(config.cot, kTargetsMax, cot_fields));
              inner.section({"markers", "of others, that are proposed to the operator as sites"},
                            [&config](FieldVisitor& of) { markers_fields(of, config.markers); });
              inner.list({"mavlink", "where the team is shown as MAVLink systems; none: nowhere"},
                         groups_of(config.mavlink, kTargetsMax, mavlink_fields));
              inner.section({"adsb", "a receiver that tells of aircraft that are not of the team"},
                            [&config](FieldVisitor& of) { adsb_fields(of, config.adsb); });
            });
}

}  // namespace skein::configuration
