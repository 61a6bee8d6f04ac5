// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "external_hosts.hpp"
#include "link_listener.hpp"
#include "skein/base/result.hpp"
#include "skein/hil/radio/link_table.hpp"
#include "skein/hil/radio/mesh.hpp"
#include "skein/hil/radio/radio_model.hpp"

namespace skein::hil {

/// What lies between the nodes of a run: one model, told to the table that the programs on this
/// machine read, to external hosts, and to a program that makes a real network's links.
class BenchRadio {
 public:
  explicit BenchRadio(const radio::RadioParams& params)
      : params_{params},
        mesh_{params.mesh ? std::optional<radio::Mesh>{*params.mesh} : std::nullopt} {}

  [[nodiscard]] Result<void> open();
  /// Precondition: open().
  [[nodiscard]] const std::string& table() const { return table_->name(); }
  void add(VehicleId node) { nodes_.push_back(node); }

  struct Moment {
    const std::map<VehicleId, Vec2>& positions;  ///< of who is known to be somewhere
    const std::set<VehicleId>& silent;           ///< their programs do not run
    const radio::Interference& interference;
    double rate = 1.0;
    Instant now{};
  };
  void move(const Moment& moment, const ExternalHosts& external, LinkListener* links);

 private:
  radio::RadioParams params_;
  std::optional<radio::LinkTable> table_;
  std::optional<radio::Mesh> mesh_;  ///< none: only who is in range is heard
  std::vector<VehicleId> nodes_;     ///< all of the radio
  std::vector<radio::Node> places_;  ///< of nodes_
};

}  // namespace skein::hil
