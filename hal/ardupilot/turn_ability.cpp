// SPDX-License-Identifier: Apache-2.0
#include "skein/ardupilot/turn_ability.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "skein/base/angles.hpp"
#include "skein/base/attitude.hpp"

namespace skein::ardupilot {
namespace {

constexpr double kBankMost_rad = radians(75.0);  ///< steeper ones are no turns
constexpr double kFilter_s = 1.0;
constexpr double kForget_s = 10.0;   ///< of turns: in straight flight nothing is forgotten
constexpr double kLeast_mps2 = 2.0;  ///< flatter turns (11 degrees) are noise
constexpr Duration kGapMost = std::chrono::milliseconds{500};

}  // namespace

double TurnAbility::share() const { return std::clamp(product_ / square_, kLeast, kMost); }

void TurnAbility::on_measurement(Instant measured, double lateral_mps2, double bank_rad) {
  const auto before = last_;
  if (before && measured <= *before) return;
  if (!(std::abs(bank_rad) <= kBankMost_rad)) return;
  last_ = measured;
  const double of_bank_mps2 = kGravity_mps2 * std::tan(bank_rad);
  if (!before || measured - *before > kGapMost) {
    flown_mps2_ = lateral_mps2;
    of_bank_mps2_ = of_bank_mps2;
    return;
  }
  const double seconds = to_seconds(measured - *before);
  const double weight = 1.0 - std::exp(-seconds / kFilter_s);
  flown_mps2_ += weight * (lateral_mps2 - flown_mps2_);
  of_bank_mps2_ += weight * (of_bank_mps2 - of_bank_mps2_);
  if (std::abs(of_bank_mps2_) < kLeast_mps2) return;
  const double keep = std::exp(-seconds / kForget_s);
  product_ = keep * product_ + seconds * flown_mps2_ * of_bank_mps2_;
  square_ = keep * square_ + seconds * of_bank_mps2_ * of_bank_mps2_;
}

}  // namespace skein::ardupilot
