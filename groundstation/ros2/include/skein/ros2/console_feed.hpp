// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/frames.hpp"
#include "skein/base/result.hpp"
#include "skein/ros2/publication.hpp"

namespace skein::ros2 {

/// Turns what the console's socket says (docs/console-socket.md) into ROS 2's messages: what is new
/// or has changed. Pure.
class ConsoleFeed {
 public:
  /// Of all positions that are not degrees: east, north, up of the mission's origin.
  static constexpr const char* kFrame = "skein_origin";

  struct Heard {
    std::vector<Publication> publications;
    std::string answer;  ///< empty: none
  };
  /// One text of the server. Fails where the console lets us in as more than an observer, or says
  /// what is not understood: then the connection is not to be used.
  [[nodiscard]] Result<Heard> on_text(std::string_view text);

 private:
  struct Vehicle {
    std::optional<double> measured_s{};
    double z_m = 0.0;
    std::vector<std::uint8_t> status{};                      ///< as it was published last
    std::optional<std::pair<std::uint64_t, double>> plan{};  ///< its number and start
  };
  struct Reading;  ///< of one text

  [[nodiscard]] builtin_interfaces::Time stamp_of(double mission_s) const;
  [[nodiscard]] std_msgs::Header header_of(double mission_s) const;
  [[nodiscard]] Wgs84 place_of(double x_m, double y_m, double z_m) const;
  Result<void> take_hello(Reading& reading);
  void take_vehicles(Reading& reading);
  void take_plans(Reading& reading);
  void take_sites(Reading& reading);
  void take_hazards(Reading& reading);
  void take_events(Reading& reading);

  std::optional<MissionOrigin> origin_;
  std::int64_t epoch_unix_ns_ = 0;
  std::string run_;
  std::uint64_t next_seq_ = 0;
  std::map<std::uint16_t, Vehicle> vehicles_;
  std::map<std::string, std::vector<std::uint8_t>, std::less<>>
      lists_;  ///< by topic, without stamps
};

}  // namespace skein::ros2
