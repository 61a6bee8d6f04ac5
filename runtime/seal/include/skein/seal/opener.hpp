// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "skein/base/time.hpp"
#include "skein/seal/header.hpp"
#include "skein/seal/keys.hpp"
#include "skein/seal/replay_window.hpp"

namespace skein::seal {

class Cipher;

enum class Opened : std::uint8_t {
  good,
  not_sealed,     ///< of another format, or too short
  unknown_epoch,  ///< we have no key for it, or no longer
  forged,         ///< not made with the key, or changed on the way
  replayed,       ///< seen before, or too old to know
  old_start,      ///< of a start before the newest that was heard of this node, or of a new one
                  ///< under a key before the newest
  no_room,        ///< good, but there are too many nodes, or too many programs with one node's id
  count
};
[[nodiscard]] const char* to_text(Opened opened);

/// Opens what others sealed. Memory is taken only for who has sealed a good datagram, and is
/// bounded. From any thread.
class Opener {
 public:
  static constexpr std::size_t kNodesMax = 4096;
  /// Programs with one id and one start number: more than one where a count of starts was lost, or
  /// a disk was copied. Who they are is for others to find out; here none may hide another.
  static constexpr std::size_t kTwinsMax = 4;

  Opener();
  ~Opener();
  Opener(const Opener&) = delete;
  Opener& operator=(const Opener&) = delete;

  /// Until `until`, by the clock of open(); another key of that epoch is replaced.
  void accept(const EpochKey& key, Instant until = Instant::max());

  struct Outcome {
    Opened opened = Opened::not_sealed;
    SenderStart from;  ///< who sealed it, if it is good; else who is said to have
  };
  /// `plain` becomes what was sealed; of no meaning unless the outcome is good. A datagram is good
  /// once.
  [[nodiscard]] Outcome open(std::span<const std::uint8_t> datagram,
                             std::vector<std::uint8_t>& plain, Instant now);

  /// Whether it would be found replayed; it is not counted.
  [[nodiscard]] bool has_opened(const Header& header) const;

  /// Of the newest key that a good datagram of that node was sealed with; 0 where there was none.
  [[nodiscard]] std::uint8_t newest_epoch_of(VehicleId node) const;

  /// How many datagrams had each outcome.
  [[nodiscard]] std::array<std::uint64_t, static_cast<std::size_t>(Opened::count)> counts() const;

 private:
  struct Epoch {
    EpochKey key;
    Instant until;
  };
  struct Start {
    std::map<std::uint8_t, std::unique_ptr<Cipher>> ciphers;  ///< by epoch
    ReplayWindow window;  ///< over all epochs: a start counts on when the key changes
  };
  struct Node {
    std::uint8_t newest_epoch = 0;
    std::uint16_t number = 0;               ///< the newest start's
    std::map<std::uint32_t, Start> starts;  ///< of that number, by their random part
  };
  /// The first that is good leaves none of the node's other starts.
  [[nodiscard]] static Opened open_under_newer_key(Node& node, const Header& header,
                                                   const EpochKey& key,
                                                   std::span<const std::uint8_t> datagram,
                                                   std::vector<std::uint8_t>& plain);
  [[nodiscard]] static Opened open_known(Start& start, const Header& header, const EpochKey& key,
                                         std::span<const std::uint8_t> datagram,
                                         std::vector<std::uint8_t>& plain);
  [[nodiscard]] Opened judge(const Header& header, std::span<const std::uint8_t> datagram,
                             std::vector<std::uint8_t>& plain, Instant now);

  mutable std::mutex mutex_;  ///< of everything below
  std::map<std::uint8_t, Epoch> epochs_;
  std::map<VehicleId, Node> nodes_;
  std::array<std::uint64_t, static_cast<std::size_t>(Opened::count)> counts_{};
};

}  // namespace skein::seal
