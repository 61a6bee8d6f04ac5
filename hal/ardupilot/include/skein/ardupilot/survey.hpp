// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "skein/ardupilot/autopilot_facts.hpp"
#include "skein/ardupilot/can_link.hpp"

namespace skein::ardupilot {

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
