// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

namespace skein::onboard {

/// `skein-onboard enrol` and `skein-onboard keys`: a vehicle's place in a mission (docs/keys.md).
class KeyCommands {
 public:
  /// Adds them to the program's command line; it must outlive this.
  explicit KeyCommands(CLI::App& app);
  ~KeyCommands() = default;
  KeyCommands(const KeyCommands&) = delete;
  KeyCommands& operator=(const KeyCommands&) = delete;

  [[nodiscard]] bool given() const;
  /// The program's exit status.
  [[nodiscard]] int run() const;

 private:
  [[nodiscard]] int request() const;
  [[nodiscard]] int store() const;
  [[nodiscard]] int show() const;

  CLI::App* enrol_ = nullptr;
  CLI::App* show_ = nullptr;
  std::uint16_t id_ = 0;
  std::string folder_;
  std::string membership_;
  bool new_keys_ = false;
  bool replace_ = false;
  bool json_ = false;
};

}  // namespace skein::onboard
