// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "skein/ardupilot/can_link.hpp"
#include "skein/mavlink/messages.hpp"

namespace skein::ardupilot {

/// A parameter as it was told: by its name or, where an autopilot has another, by that one.
struct TestedParameter {
  std::string name;
  std::optional<double> value;  ///< none: not told
  std::string finding;          ///< empty: it is good
};

/// What is on a bus, and what its autopilot says of itself.
struct AutopilotFacts {
  std::vector<std::uint8_t> nodes;         ///< heard, but ours
  std::uint64_t frames = 0;                ///< received
  bool own_id_taken = false;               ///< somebody sends with our node id: nothing was asked
  bool node_heard = false;                 ///< the flight controller's
  bool serial_heard = false;               ///< its serial port, for us
  std::optional<AutopilotNotice> trouble;  ///< of the link, the lowest that there is
  std::optional<mavlink::Heartbeat> heartbeat;
  std::optional<std::uint32_t> firmware;
  std::optional<mavlink::SysStatus> health;
  std::optional<mavlink::GpsRawInt> gnss;
  std::optional<mavlink::EkfStatusReport> filter;
  std::optional<mavlink::SystemTime> time;
  Instant time_at;  ///< when it came
  std::optional<mavlink::ExtendedSysState> landed;
  std::vector<TestedParameter> safety;  ///< that nothing is flown without (parameter_check.hpp)
  std::map<std::string, double> parameters;  ///< the others, as far as they were told
  std::vector<std::string> pre_arm;          ///< why it would not arm

  [[nodiscard]] bool prearm_good() const;
  /// It would arm in another mode, into which a companion that launches it puts it.
  [[nodiscard]] bool only_mode_forbids_arming() const;
};
/// "LOITER".
[[nodiscard]] std::string mode_of(Airframe airframe, const mavlink::Heartbeat& heartbeat);
[[nodiscard]] bool is_of_airframe(Airframe airframe, const mavlink::Heartbeat& heartbeat);

/// Asks an autopilot for all that is to be known before a flight. It only listens until it is
/// sure that nobody else has our node id, and sends neither HEARTBEAT nor anything that changes
/// what the autopilot does: that one would else wait for us (FS_GCS_ENABL). No clock: see CanLink.
class Survey {
 public:
  static constexpr Duration kListen = std::chrono::milliseconds{1200};
  /// HEARTBEAT comes each second.
  static constexpr Duration kFoundWithin = std::chrono::seconds{4};
  static constexpr Duration kAnsweredWithin = std::chrono::seconds{6};  ///< from then on

  Survey(std::unique_ptr<can::Bus> bus, const CanLinkParams& params, Instant now);
  ~Survey();
  Survey(const Survey&) = delete;
  Survey& operator=(const Survey&) = delete;

  /// To be called when descriptor() is readable, and every 10 ms or so. True once it is over.
  [[nodiscard]] bool step(Instant now);
  [[nodiscard]] const can::Bus& bus() const;
  /// Precondition: it is over.
  [[nodiscard]] const AutopilotFacts& facts() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace skein::ardupilot
