// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <string>

namespace skein::console {

/// How long who has named wrong passwords waits until another is looked at: longer each time, and
/// each address by itself, so that whoever guesses does not lock out the operator elsewhere.
class LoginWaits {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr int kFree = 3;  ///< wrong ones without a wait
  static constexpr std::chrono::seconds kMax{60};
  static constexpr std::chrono::minutes kForgotten{10};
  static constexpr std::size_t kAddressesMax = 1024;

  /// None: now.
  [[nodiscard]] std::optional<std::chrono::seconds> wait(const std::string& address,
                                                         Time now) const;
  /// How many in a row that makes.
  int wrong(const std::string& address, Time now);
  void right(const std::string& address) { known_.erase(address); }

 private:
  struct Entry {
    int wrong = 0;
    Time last;
    [[nodiscard]] Time until() const;
  };
  std::map<std::string, Entry> known_;
};

}  // namespace skein::console
