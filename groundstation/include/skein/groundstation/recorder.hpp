// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/mission/messages.hpp"
#include "skein/recording/writer.hpp"

namespace skein::groundstation {

/// The ground station's recordings: that of its configuration, from its start to its end, and one
/// beside it that an operator begins and ends. For one thread.
class Recorder {
 public:
  /// `folder` empty: none of the configuration.
  [[nodiscard]] static Result<Recorder> open(const std::string& folder,
                                             recording::Writer::Options options);

  /// Into `folder` from now on, in place of an earlier folder of an operator. Fails, and leaves
  /// everything as it is, where something is recorded there already or nothing can be.
  [[nodiscard]] Result<void> begin(const std::string& folder);
  /// Fails where no operator has begun one.
  [[nodiscard]] Result<void> end();

  /// As it was sent or heard.
  void write(const mission::Message& message, VehicleId sender, Instant now);
  void write(const mission::MissionEvent& event);
  /// Its places once, however often it is sent.
  void write_places(const formation::Change& change);
  /// How many run.
  [[nodiscard]] std::size_t running() const { return running_.size(); }
  /// To the system. A recording that fails ends, with an error in the log.
  void flush();

 private:
  struct Running {
    std::string folder;
    recording::Writer writer;
    bool ordered = false;      ///< by an operator
    std::uint32_t change = 0;  ///< whose places are in it
  };

  explicit Recorder(recording::Writer::Options options) : options_{std::move(options)} {}
  [[nodiscard]] Result<void> add(const std::string& folder, bool ordered);

  recording::Writer::Options options_;
  std::vector<Running> running_;
};

}  // namespace skein::groundstation
