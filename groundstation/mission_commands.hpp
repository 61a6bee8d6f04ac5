// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace skein::groundstation {

/// `skein-ground mission` and `skein-ground keys`: who takes part in a mission (docs/keys.md).
class MissionCommands {
 public:
  /// Adds them to the program's command line; it must outlive this.
  explicit MissionCommands(CLI::App& app);
  ~MissionCommands() = default;
  MissionCommands(const MissionCommands&) = delete;
  MissionCommands& operator=(const MissionCommands&) = delete;

  [[nodiscard]] const CLI::App& mission() const { return *mission_; }
  [[nodiscard]] const CLI::App& keys() const { return *keys_; }
  /// Of another ground station than the mission's own.
  [[nodiscard]] const CLI::App& enrolment() const { return *enrolment_; }
  /// What was given of them. The program's exit status.
  [[nodiscard]] int run() const;

 private:
  CLI::App& add(CLI::App& to, const char* name, const char* description,
                std::function<int()> action);
  void add_create();
  void add_enrol();
  void add_enrolment(CLI::App& app);
  void add_revoke();
  void add_operator();
  void add_show();
  [[nodiscard]] int create() const;
  [[nodiscard]] int enrol() const;
  [[nodiscard]] int ask_to_enrol() const;
  [[nodiscard]] int keep_answer() const;
  [[nodiscard]] int revoke() const;
  [[nodiscard]] int enrol_operator() const;
  [[nodiscard]] int show() const;

  CLI::App* mission_ = nullptr;
  CLI::App* keys_ = nullptr;
  CLI::App* enrolment_ = nullptr;
  std::map<const CLI::App*, std::function<int()>> actions_;

  std::string folder_{"/var/lib/skein/ground/keys"};
  std::string name_;
  int days_ = 30;
  std::vector<std::string> requests_;
  std::string out_;
  bool yes_ = false;
  std::string kind_;
  std::string which_;
  bool json_ = false;
  std::uint16_t station_ = 0;
  std::string membership_;
  bool new_keys_ = false;
  bool replace_ = false;
};

}  // namespace skein::groundstation
