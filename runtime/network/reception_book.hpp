// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/network/node.hpp"
#include "skein/seal/replay_window.hpp"

namespace skein::network {

/// Counts of each sender what came of it directly and what did not, by the numbers that it gives to
/// what it sends. Only for people to look at: whoever forges numbers makes a figure wrong, and no
/// more. Memory is bounded; from any thread.
class ReceptionBook {
 public:
  static constexpr std::size_t kSendersMax = 4096;
  static constexpr std::size_t kStreamsMax = 64;  ///< of a sender
  /// A sender that leaps further than this has begun anew.
  static constexpr std::uint64_t kLeapMax = 10'000;

  /// Numbers of their own, each one more than the one before: of one start of a program, and one
  /// of its channels.
  struct Stream {
    VehicleId sender;
    InstanceId instance;
    std::uint8_t channel = 0;
  };

  /// That one has come from its sender itself.
  void came(const Stream& stream, std::uint64_t number, std::size_t bytes, Instant now);
  /// That one was sent: others have passed it on.
  void was_sent(const Stream& stream, std::uint64_t number, Instant now);

  /// Of the last Node::kReceptionFor, ascending by sender; who has sent nothing is left out.
  [[nodiscard]] std::vector<Reception> all(Instant now) const;

 private:
  static constexpr std::int64_t kSlots = Node::kReceptionFor / std::chrono::seconds{1};
  struct Slot {
    std::int64_t second = -1;
    std::uint32_t came = 0;
    std::int32_t missed = 0;  ///< what comes late is taken off again
    std::uint64_t bytes = 0;
  };
  struct Numbers {
    std::uint64_t newest = 0;
    seal::ReplayWindow came;
  };
  struct Sender {
    std::array<Slot, kSlots> slots;
    std::map<std::pair<InstanceId, std::uint8_t>, Numbers> streams;
  };

  void note(const Stream& stream, std::uint64_t number, bool itself, std::size_t bytes,
            Instant now);
  static Slot& slot_of(Sender& sender, Instant now);
  [[nodiscard]] static Reception reception_of(VehicleId id, const Sender& sender, Instant now);
  void forget(Instant now);

  mutable std::mutex mutex_;
  std::map<VehicleId, Sender> senders_;
  Instant next_forget_ = Instant::min();  ///< whoever makes up senders shall not cost a look at all
};

}  // namespace skein::network
