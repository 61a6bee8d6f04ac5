// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "skein/codec/codec.hpp"

namespace skein::codec {

inline bool is_utf8(const std::string& text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    std::size_t more = 0;
    if (lead < 0x80U) {
      more = 0;
    } else if (lead >= 0xC2U && lead < 0xE0U) {
      more = 1;
    } else if (lead >= 0xE0U && lead < 0xF0U) {
      more = 2;
    } else if (lead >= 0xF0U && lead < 0xF5U) {
      more = 3;
    } else {
      return false;
    }
    if (text.size() - i <= more) return false;
    for (std::size_t k = 1; k <= more; ++k) {
      if ((static_cast<unsigned char>(text[i + k]) & 0xC0U) != 0x80U) return false;
    }
    i += more + 1;
  }
  return true;
}

/// Takes fields over and remembers whether one was out of range.
class Check {
 public:
  explicit Check(bool& ok) : ok_{ok} {}

  double within(double value, double low, double high) {
    require(value >= low && value <= high);  // false for what is not a number
    return value;
  }
  double distance(double m) { return within(m, 0.0, kDistanceMaxM); }
  double coordinate(double m) { return within(m, -kDistanceMaxM, kDistanceMaxM); }
  double speed(double mps) { return within(mps, 0.0, kSpeedMaxMps); }
  double angle(double rad) { return within(rad, -kAngleMaxRad, kAngleMaxRad); }
  double curvature(double per_m) { return within(per_m, -kCurvatureMaxPerM, kCurvatureMaxPerM); }
  double amount(double value) { return within(value, 0.0, kNumberMax); }
  Instant instant(std::int64_t ns) {
    require(ns >= -kTimeMax.count() && ns <= kTimeMax.count());
    return Instant{Duration{ns}};
  }
  Duration duration(std::int64_t ns) {
    require(ns >= 0 && ns <= kTimeMax.count());
    return Duration{ns};
  }
  template <class To, class From>
  To enumerator(From value) {
    const auto number = static_cast<std::uint32_t>(value);
    const bool known = number < static_cast<std::uint32_t>(To::count);
    require(known);
    return known ? static_cast<To>(number) : To{};
  }
  std::string text(const std::string& value) {
    require(value.size() <= coalition::kReasonMax && is_utf8(value));
    return value;
  }
  template <class In, class Convert>
  auto each(const std::vector<In>& from, std::size_t limit, Convert convert) {
    std::vector<decltype(convert(*this, from.front()))> to;
    require(from.size() <= limit);
    if (!ok_) return to;
    to.reserve(from.size());
    for (const In& item : from) to.push_back(convert(*this, item));
    return to;
  }
  void require(bool condition) { ok_ = ok_ && condition; }

 private:
  bool& ok_;
};

}  // namespace skein::codec
