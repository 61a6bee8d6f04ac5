// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace skein::onboard {

/// `skein-onboard check`: all that can be looked at before a flight (docs/ardupilot.md).
class CheckCommand {
 public:
  /// Adds it to the program's command line; it must outlive this.
  explicit CheckCommand(CLI::App& app);

  [[nodiscard]] bool given() const { return check_->parsed(); }
  /// The program's exit status.
  [[nodiscard]] int run() const;

 private:
  CLI::App* check_ = nullptr;
  std::string config_;
  bool json_ = false;
};

}  // namespace skein::onboard
