// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/hil/radio/radio_model.hpp"

namespace skein::hil::radio {

/// How every node hears every other, in shared memory: written by the bench while the vehicles
/// move, read by the radio in every process; times in it are real. Ids 0 (ground station) to
/// kNodes - 1; others pass untouched. Each field is atomic; a reader may see those of two updates
/// mixed, which a radio does not mind. Wait-free both ways.
class LinkTable {
 public:
  static constexpr std::size_t kNodes = 1024;

  /// Makes the table under a name that nobody has ("/skein-radio-PID-N"); all hear all, and
  /// perfectly. The name goes with the object.
  [[nodiscard]] static Result<LinkTable> create();
  /// A table of this process alone; all hear all, and perfectly.
  [[nodiscard]] static Result<LinkTable> create_private();
  /// Opens an existing table, read-only in spirit. Fails with the name where there is none.
  [[nodiscard]] static Result<LinkTable> open(const std::string& name);

  ~LinkTable();
  LinkTable(LinkTable&& other) noexcept;
  LinkTable& operator=(LinkTable&&) = delete;
  LinkTable(const LinkTable&) = delete;
  LinkTable& operator=(const LinkTable&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  /// How every hop is.
  void set(const Link& hop);
  /// Over how many (skein/hil/radio/mesh.hpp); 0: there is no way.
  void set_hops(VehicleId from, VehicleId to, int hops);
  [[nodiscard]] Link get(VehicleId from, VehicleId to) const;

 private:
  struct Hop {
    std::atomic<bool> disordered;
    std::atomic<double> loss;
    std::atomic<double> duplicates;
    std::atomic<double> held_back;
    std::atomic<Duration::rep> delay_ns;
    std::atomic<Duration::rep> jitter_ns;
    std::atomic<Duration::rep> held_back_max_ns;
    std::atomic<double> bytes_per_s;  ///< 0: there is always room
  };
  static_assert(std::atomic<bool>::is_always_lock_free);
  static_assert(std::atomic<double>::is_always_lock_free);
  static_assert(std::atomic<Duration::rep>::is_always_lock_free);
  static_assert(std::atomic<std::uint8_t>::is_always_lock_free);
  struct Table {
    Hop hop;
    std::array<std::array<std::atomic<std::uint8_t>, kNodes>, kNodes> hops;  ///< [from][to]
  };

  LinkTable(std::string name, Table* table, bool owner)
      : name_{std::move(name)}, table_{table}, owner_{owner} {}
  [[nodiscard]] static Result<LinkTable> map(std::string name, int descriptor, bool owner);
  void all_hear_all();

  std::string name_;
  Table* table_;
  bool owner_;
};

}  // namespace skein::hil::radio
