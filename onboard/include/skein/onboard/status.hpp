// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/hal/flight_controller.hpp"
#include "skein/mission/host_watch.hpp"
#include "skein/mission/messages.hpp"
#include "skein/network/node.hpp"
#include "skein/process/host.hpp"

namespace skein::onboard {

/// What a vehicle's process tells of itself to this host, whoever asks.
struct Status {
  mission::Health health;  ///< as it was last told to the team; its time before the first: zero
  Instant now{};
  hal::Airborne airborne = hal::Airborne::unknown;
  std::optional<process::ClockState> clock;
  struct Recording {
    std::string folder;
    std::optional<std::uint64_t> free_bytes;  ///< of its file system
    std::uint64_t bytes = 0;
    double bytes_per_s = 0.0;
  };
  std::optional<Recording> recording;       ///< none: it records nothing
  std::uint64_t overruns = 0;               ///< control periods that were missed
  std::uint64_t stale_states = 0;           ///< control periods without a fresh state
  std::chrono::nanoseconds control_age{0};  ///< since control was seen to get on
  std::chrono::nanoseconds agent_age{0};
  bool watched = false;  ///< by the service manager
  std::uint64_t network_restarts = 0;
};

/// Where the packages' services have the sockets that ask_status() asks.
inline constexpr const char* kStatusSockets = "/run/skein";
[[nodiscard]] inline std::string status_socket_of(VehicleId vehicle) {
  return std::string{kStatusSockets} + "/onboard-" + std::to_string(vehicle.value) + ".sock";
}

/// One line of JSON, without its end.
[[nodiscard]] std::string status_json(const Status& status);
/// The same for people, from that line; fails where it is none.
[[nodiscard]] Result<std::string> status_text(const std::string& json);
/// Whether the vehicle may be in the air, from that line.
[[nodiscard]] hal::Airborne airborne_in(const std::string& json);

/// The newest Health, from the agent's thread to whoever tells the host.
class HealthBoard {
 public:
  void put(const mission::Health& health) {
    const std::lock_guard lock{mutex_};
    health_ = health;
  }
  [[nodiscard]] mission::Health get() const {
    const std::lock_guard lock{mutex_};
    return health_;
  }

  /// The other way: what the host knows, among what the agent tells.
  void put(const mission::HostFacts& facts) {
    const std::lock_guard lock{mutex_};
    host_ = facts;
  }
  [[nodiscard]] mission::Health with_host(mission::Health health) const;

 private:
  mutable std::mutex mutex_;
  mission::Health health_;
  mission::HostFacts host_;
};

/// With what the network has counted of those that the agent hears.
[[nodiscard]] mission::Health with_receptions(mission::Health health,
                                              const std::vector<network::Reception>& receptions);

/// A Unix socket that gives whoever connects one line, and closes: for the crew, for scripts, for
/// an upgrade that must know whether the vehicle flies. What nobody listens on any more is taken
/// over; the file is for the user and the group of the process, and goes with this object.
class StatusSocket {
 public:
  /// Fails where the folder is missing or another process listens.
  [[nodiscard]] static Result<std::unique_ptr<StatusSocket>> open(const std::string& path);
  ~StatusSocket();
  StatusSocket(const StatusSocket&) = delete;
  StatusSocket& operator=(const StatusSocket&) = delete;

  /// Answers all that wait, without waiting for anybody.
  void serve(const std::function<std::string()>& line) const;

 private:
  StatusSocket(int descriptor, std::string path)
      : descriptor_{descriptor}, path_{std::move(path)} {}
  int descriptor_;
  std::string path_;
};

/// Why a status could not be had. Nobody is there only where that is certain: an upgrade goes by
/// it.
enum class NoStatus : std::uint8_t { nobody_there, not_allowed, no_answer };
struct AskedStatus {
  std::string line;                ///< empty where there is none
  std::optional<NoStatus> failed;  ///< and why
};
/// Asks a process for its line, and waits so long, though others wait before it.
[[nodiscard]] AskedStatus ask_status(const std::string& path, std::chrono::milliseconds at_most);

}  // namespace skein::onboard
