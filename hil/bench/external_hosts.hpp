// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/configuration/deployment.hpp"
#include "skein/configuration/host.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/configuration/vehicle_config.hpp"
#include "skein/fleet/fleet.hpp"
#include "skein/hil/radio/link_feed.hpp"

namespace skein::hil {

/// The vehicles of a run whose programs are on other machines: configured, started, told of the
/// radio, ended, and their recordings fetched. What was started is ended with the object at the
/// latest. The ground station remains the bench's, but where it is among them it is on a network of
/// its own.
class ExternalHosts {
 public:
  /// Of these vehicles, with the hosts that the scenario names. Fails where one has no host, is not
  /// of the scenario, or a fault would kill it; and where the ground station is not on this
  /// machine.
  [[nodiscard]] static Result<ExternalHosts> make(const configuration::Scenario& scenario,
                                                  const std::vector<VehicleId>& vehicles);
  ~ExternalHosts();
  ExternalHosts(ExternalHosts&&) noexcept;
  ExternalHosts& operator=(ExternalHosts&&) = delete;
  ExternalHosts(const ExternalHosts&) = delete;
  ExternalHosts& operator=(const ExternalHosts&) = delete;

  [[nodiscard]] bool empty() const { return hosts_.empty(); }
  [[nodiscard]] bool has(VehicleId vehicle) const { return host_of(vehicle) != nullptr; }
  /// Null for a vehicle of the bench.
  [[nodiscard]] const configuration::Host* host_of(VehicleId vehicle) const;
  [[nodiscard]] std::size_t vehicles() const { return hosts_.size(); }
  /// The ground station's, where it is external; else null. Its program is started here, after the
  /// words of its `run`.
  [[nodiscard]] const configuration::Host* ground() const { return ground_ ? &*ground_ : nullptr; }
  /// Of all of them, the ground station too.
  [[nodiscard]] std::map<VehicleId, std::string> addresses() const;

  /// Of these configurations those of external vehicles, each as its host needs it: pushed, and
  /// started with an emulated flight controller where it has none. All hosts at once. Fails where
  /// one does not do it, or flies already.
  [[nodiscard]] Result<void> start(const std::vector<configuration::VehicleConfig>& configs);

  /// To the vehicle's host: how the vehicle hears others at this moment.
  void tell(const radio::Hearing& hearing) const;

  /// Ends what was started; a sentence for each program that did not end as it was asked to.
  [[nodiscard]] std::vector<std::string> stop();
  /// Fetches what they recorded, each into its folder of the run; gives those whose recordings are
  /// not to be had, and why.
  struct Missing {
    VehicleId vehicle;
    std::string why;
  };
  [[nodiscard]] std::vector<Missing> collect(const std::filesystem::path& run_folder);

 private:
  explicit ExternalHosts(std::vector<configuration::Host> hosts) : hosts_{std::move(hosts)} {}
  struct Started {
    configuration::Host host;
    std::string recordings;
    /// In the order of their start; a flight controller outlives its companion.
    std::vector<fleet::Program> programs;
    bool aircraft = false;  ///< with a flight controller of its own: not ours to end in flight
    bool ours = false;      ///< otherwise somebody else flies it, and it is not for us to end
  };
  [[nodiscard]] static Result<void> bring_up(Started& started);

  std::vector<configuration::Host> hosts_;  ///< of vehicles
  std::optional<configuration::Host> ground_;
  std::vector<Started> started_;
  std::optional<radio::FeedSender> feed_;
};

/// What of the scenario is the hosts' to say: the buses of flight controllers that are there.
void give_buses(configuration::Scenario& scenario, const ExternalHosts& hosts);

}  // namespace skein::hil
