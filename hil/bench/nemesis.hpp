// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/hil/child_process.hpp"
#include "skein/hil/fault.hpp"
#include "skein/hil/program_spans.hpp"

namespace skein::hil {

/// Does to the programs of nodes what faults say, and notes it. Whatever it has stopped goes on
/// when the object goes.
class Nemesis {
 public:
  struct Hands {
    std::map<VehicleId, ChildProcess>& programs;
    /// In place of what ended; none of its files may be larger than so many bytes, where given.
    std::function<Result<void>(VehicleId, std::optional<std::size_t>)> start;
    std::function<void(const std::string&)> say;
  };
  explicit Nemesis(Hands hands) : hands_{std::move(hands)} {}
  ~Nemesis() { let_go(); }
  Nemesis(const Nemesis&) = delete;
  Nemesis& operator=(const Nemesis&) = delete;

  /// How far its clock is ahead from the start, which a later step adds to.
  void set_clock(VehicleId node, Duration off) { clock_off_[node] = off; }
  /// A fault begins. False: it is none of these, and nothing is done. A program that is down or
  /// gone for good is left alone.
  [[nodiscard]] bool begin(const Fault& fault, const std::vector<VehicleId>& who, Instant now);
  /// What is due by then: starts, what goes on, and who is slow stands still or goes on until the
  /// next call, by what its share lacks; so it is called several times a second. Fails where a
  /// program cannot be started.
  [[nodiscard]] Result<void> step(Instant now);

  [[nodiscard]] bool has_stopped(VehicleId node) const {
    const auto found = stopped_.find(node);
    return found != stopped_.end() && found->second;
  }
  [[nodiscard]] bool is_down(VehicleId node) const { return start_at_.contains(node); }
  [[nodiscard]] bool anybody_down() const { return !start_at_.empty(); }
  /// It was killed for good.
  void note_gone(VehicleId node, Instant now);
  /// Everything goes on, for good.
  void let_go();
  [[nodiscard]] const ProgramSpans& spans() const { return spans_; }
  /// How far its clock is ahead, for a program that starts.
  [[nodiscard]] Duration clock_off(VehicleId node) const {
    const auto found = clock_off_.find(node);
    return found == clock_off_.end() ? Duration{} : found->second;
  }

  /// What a full disk leaves room for in a file: a start's number, and a few lines of a log.
  static constexpr std::size_t kRoom_bytes = 16384;

 private:
  struct Slow {
    double stopped_share = 0.0;
    Instant from{};
    Instant until{};
    Instant seen_at{};   ///< by step()
    Duration stopped{};  ///< of the time from `from` to `seen_at`
  };
  void end(VehicleId node, Duration down_for, Instant now);
  void stand_still(VehicleId node, Duration time, Instant now);
  void set_running(VehicleId node, bool runs);
  [[nodiscard]] bool should_run(VehicleId node, Instant now) const;
  [[nodiscard]] ChildProcess* running(VehicleId node);
  [[nodiscard]] ProgramSpan& span_of(VehicleId node, ProgramSpan::Kind kind);

  Hands hands_;
  std::map<VehicleId, Instant> start_at_;
  std::map<VehicleId, Instant> still_until_;
  std::map<VehicleId, Slow> slow_;
  std::map<VehicleId, bool> stopped_;  ///< true: it was sent SIGSTOP last
  std::map<VehicleId, Duration> clock_off_;
  std::map<VehicleId, bool> disk_full_;
  ProgramSpans spans_;
};

}  // namespace skein::hil
