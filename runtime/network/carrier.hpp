// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "skein/network/node.hpp"
#include "skein/seal/opener.hpp"
#include "skein/seal/sealer.hpp"

namespace skein::network {

/// What a carrier is told of its node: nothing by which decisions are signed.
struct CarrierConfig {
  std::uint32_t domain = 0;
  VehicleId self;
  InstanceId instance;
  std::uint8_t run = 0;  ///< the how-manieth carrier of this instance; wraps around
  codec::Role role = codec::Role::vehicle;
  Endpoint endpoint;
  std::vector<PeerConfig> peers;
  std::optional<AirConfig> air;
  struct Seal {
    seal::SenderStart start;
    seal::EpochKey key;
    seal::CounterRange counters;
  };
  std::optional<Seal> seal;
  bool overhears = false;                 ///< by the air
  std::vector<std::uint8_t> certificate;  ///< told to all; of a node that signs, else empty
  std::string transport_plugin;
};

/// Without certificate; the counters are all of the start's.
[[nodiscard]] CarrierConfig carrier_config(const NodeConfig& config);

enum class CarrierCount : std::uint8_t {
  unknown_sender,
  lost,  ///< by a carrier of its own process: its node was slower than it, or DDS had no room
  misformed,
  air_passed_on,  ///< this and the next three: air::LinkCounts
  air_repairs,
  air_gave_way,
  air_lost,
  opened,  ///< this and the rest: seal::Opened
  count = opened + static_cast<std::uint8_t>(seal::Opened::count)
};
using CarrierCounts = std::array<std::uint64_t, static_cast<std::size_t>(CarrierCount::count)>;

/// What comes in. Called on threads of the carrier; must be short, must not call the carrier.
class CarrierSink {
 public:
  /// As heard; `instance` as far as a GUID has it: all of one that has keys.
  virtual void on_sample(codec::Topic topic, VehicleId sender, InstanceId instance,
                         std::span<const std::uint8_t> bytes) = 0;
  /// As its node told it, which may be anybody's.
  virtual void on_certificate(std::span<const std::uint8_t> certificate) = 0;

 protected:
  ~CarrierSink() = default;
};

/// What became of a sample that was given to a carrier.
enum class Written : std::uint8_t {
  yes,
  no_room,
  no_network,  ///< the carrier is just being started again
};

/// Carries the bytes of topics between nodes and knows nothing of what they say. All functions may
/// be called from any thread, and wait for nobody.
class Carrier {
 public:
  Carrier() = default;
  Carrier(const Carrier&) = delete;
  Carrier& operator=(const Carrier&) = delete;
  virtual ~Carrier() = default;

  /// Precondition: the node's role writes that topic.
  [[nodiscard]] virtual Written write(codec::Topic topic, std::vector<std::uint8_t> bytes) = 0;
  [[nodiscard]] virtual std::vector<Peer> peers() const = 0;
  [[nodiscard]] virtual std::vector<Reception> receptions() const = 0;
  /// Precondition of these three: it seals.
  virtual void change_key(const seal::EpochKey& key, Duration old_for) = 0;
  virtual void tell(const std::vector<KeyNews>& news) = 0;
  [[nodiscard]] virtual std::optional<std::vector<std::uint8_t>> take_key_news() = 0;
  [[nodiscard]] virtual CarrierCounts counts() const = 0;
  /// What people should know of it since the last call.
  [[nodiscard]] virtual std::vector<std::string> take_troubles() { return {}; }
  [[nodiscard]] virtual std::uint64_t restarts() const { return 0; }
};

/// Fast DDS in this process.
[[nodiscard]] Result<std::unique_ptr<Carrier>> open_dds_carrier(CarrierConfig config,
                                                                CarrierSink& sink);
/// Everything once, for all who hear it (skein/air), in this process; `air` must be given.
[[nodiscard]] Result<std::unique_ptr<Carrier>> open_air_carrier(CarrierConfig config,
                                                                CarrierSink& sink);
/// Fast DDS in a process of its own (skein/network/carrier_process.hpp), which is watched and
/// started again. Returns when it has joined the network, or with why it cannot.
[[nodiscard]] Result<std::unique_ptr<Carrier>> open_carrier_process(CarrierConfig config,
                                                                    CarrierSink& sink);

}  // namespace skein::network
