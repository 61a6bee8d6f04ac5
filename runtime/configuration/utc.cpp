// SPDX-License-Identifier: Apache-2.0
#include "skein/configuration/utc.hpp"

#include <array>
#include <charconv>
#include <chrono>
#include <cstdio>

namespace skein::configuration {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::size_t kSecondsEnd = 19;  // "2026-11-23T08:00:00"
constexpr std::size_t kFractionMax = 9;

/// The digits from `at` on, as a number.
std::optional<int> digits(std::string_view text, std::size_t at, std::size_t count) {
  int value = 0;
  const char* const first = text.data() + at;
  const auto end = std::from_chars(first, first + count, value);
  if (end.ec != std::errc{} || end.ptr != first + count || *first == '-') return std::nullopt;
  return value;
}

/// Of ".25", in nanoseconds.
std::optional<std::int64_t> fraction_ns(std::string_view text) {
  if (text.empty()) return 0;
  if (text[0] != '.' || text.size() < 2 || text.size() > 1 + kFractionMax) return std::nullopt;
  const auto value = digits(text, 1, text.size() - 1);
  if (!value) return std::nullopt;
  std::int64_t ns = *value;
  for (std::size_t i = text.size() - 1; i < kFractionMax; ++i) ns *= 10;
  return ns;
}

}  // namespace

std::string utc_text(std::int64_t unix_ns) {
  using std::chrono::days;
  const std::chrono::sys_time<std::chrono::nanoseconds> at{std::chrono::nanoseconds{unix_ns}};
  const auto day = std::chrono::floor<days>(at);
  const std::chrono::year_month_day date{day};
  const std::chrono::hh_mm_ss time{at - day};
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%04d-%02u-%02uT%02d:%02d:%02d", int{date.year()},
                unsigned{date.month()}, unsigned{date.day()},
                static_cast<int>(time.hours().count()), static_cast<int>(time.minutes().count()),
                static_cast<int>(time.seconds().count()));
  std::string utc = text.data();
  if (const auto ns = time.subseconds().count(); ns != 0) {
    std::snprintf(text.data(), text.size(), ".%09d", static_cast<int>(ns));
    utc += text.data();
    utc.erase(utc.find_last_not_of('0') + 1);
  }
  return utc + "Z";
}

std::optional<std::int64_t> parse_utc(std::string_view text) {
  if (text.size() <= kSecondsEnd || text.back() != 'Z') return std::nullopt;
  text.remove_suffix(1);
  for (const auto& [at, mark] :
       {std::pair{4U, '-'}, {7U, '-'}, {10U, 'T'}, {13U, ':'}, {16U, ':'}}) {
    if (text[at] != mark) return std::nullopt;
  }
  const auto year = digits(text, 0, 4);
  const auto month = digits(text, 5, 2);
  const auto day = digits(text, 8, 2);
  const auto hour = digits(text, 11, 2);
  const auto minute = digits(text, 14, 2);
  const auto second = digits(text, 17, 2);
  const auto fraction = fraction_ns(text.substr(kSecondsEnd));
  if (!year || !month || !day || !hour || !minute || !second || !fraction) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year{*year},
                                         std::chrono::month{static_cast<unsigned>(*month)},
                                         std::chrono::day{static_cast<unsigned>(*day)}};
  if (!date.ok() || *year < 1970 || *year > 2200) return std::nullopt;
  if (*hour > 23 || *minute > 59 || *second > 59) return std::nullopt;
  const auto at = std::chrono::sys_days{date} + std::chrono::hours{*hour} +
                  std::chrono::minutes{*minute} + std::chrono::seconds{*second};
  return at.time_since_epoch().count() * kSecond_ns + *fraction;
}

}  // namespace skein::configuration
