// SPDX-License-Identifier: Apache-2.0
#include "field_types.hpp"

#include <array>
#include <charconv>

#include "skein/base/angles.hpp"

namespace skein::configuration {
namespace {

/// The shortest decimal that comes back as `value`, so that 15 degrees do not
/// read 15.000000000000002.
template <class T, class Inward>
double shown_as(double outside, const T& value, const Inward& inward) {
  for (int digits = 6; digits < 17; ++digits) {
    std::array<char, 32> text{};
    const auto written = std::to_chars(text.data(), text.data() + text.size(), outside,
                                       std::chars_format::general, digits);
    double rounded = 0.0;
    std::from_chars(text.data(), written.ptr, rounded);
    if (inward(rounded) == value) return rounded;
  }
  return outside;
}

template <class T, class Outward, class Inward>
void converted(FieldVisitor& v, const Field& field, const Range& range, T& value,
               const Outward& outward, const Inward& inward) {
  double shown = shown_as(outward(value), value, inward);
  const double before = shown;
  v.number(field, range, shown);
  if (shown != before) value = inward(shown);
}

constexpr Range kCompass{-360.0, 360.0, "deg"};

}  // namespace

void seconds(FieldVisitor& v, const Field& field, const Range& range, Duration& value) {
  converted(
      v, field, range, value, [](Duration d) { return to_seconds(d); }, from_seconds);
}

void seconds(FieldVisitor& v, const Field& field, const Range& range, Instant& value) {
  converted(
      v, field, range, value, [](Instant t) { return to_seconds(t); }, at_seconds);
}

void milliseconds(FieldVisitor& v, const Field& field, const Range& range, Duration& value) {
  converted(
      v, field, range, value, [](Duration d) { return to_seconds(d) * 1e3; },
      [](double ms) { return from_seconds(ms * 1e-3); });
}

void compass(FieldVisitor& v, const Field& field, double& heading_rad) {
  converted(v, field, kCompass, heading_rad, compass_deg_from_heading, heading_from_compass_deg);
}

void compass(FieldVisitor& v, const Field& field, std::optional<double>& heading_rad) {
  std::optional<double> shown;
  if (heading_rad) {
    shown =
        shown_as(compass_deg_from_heading(*heading_rad), *heading_rad, heading_from_compass_deg);
  }
  const std::optional<double> before = shown;
  v.number(field, kCompass, shown);
  if (shown == before) return;
  heading_rad.reset();
  if (shown) heading_rad = heading_from_compass_deg(*shown);
}

void angle(FieldVisitor& v, const Field& field, const Range& range, double& rad) {
  converted(v, field, range, rad, degrees, radians);
}

}  // namespace skein::configuration
