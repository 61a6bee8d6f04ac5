// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/dubins_batch.hpp"

#include <array>

#include "dubins_lanes.hpp"
#include "skein/base/assert.hpp"

namespace skein::planning {
namespace {

using Baseline = DubinsLanes<2>;

std::size_t count_levels() {
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("avx2")) return 1;
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") ? 3 : 2;
#else
  return 1;
#endif
}

DubinsColumns pointers(const PoseColumns& poses, std::size_t count) {
  const std::size_t size = poses.x_m.size();
  SKEIN_ASSERT(size == 1 || size == count);
  SKEIN_ASSERT(poses.y_m.size() == size && poses.heading_rad.size() == size);
  SKEIN_ASSERT(poses.cos.size() == poses.sin.size());
  SKEIN_ASSERT(poses.cos.empty() || poses.cos.size() == size);
  const bool cached = !poses.cos.empty();
  return {poses.x_m.data(),
          poses.y_m.data(),
          poses.heading_rad.data(),
          cached ? poses.cos.data() : nullptr,
          cached ? poses.sin.data() : nullptr,
          size == count ? std::size_t{1} : std::size_t{0}};
}

}  // namespace

void PoseBatch::push_back(const Pose2& pose) {
  const auto both = Baseline::sin_cos(Baseline::tame(Baseline::splat(pose.heading_rad)));
  x_m_.push_back(pose.x_m);
  y_m_.push_back(pose.y_m);
  heading_rad_.push_back(pose.heading_rad);
  cos_.push_back(both.cos[0]);
  sin_.push_back(both.sin[0]);
}

void PoseBatch::reserve(std::size_t poses) {
  for (auto* column : {&x_m_, &y_m_, &heading_rad_, &cos_, &sin_}) column->reserve(poses);
}

void PoseBatch::clear() {
  for (auto* column : {&x_m_, &y_m_, &heading_rad_, &cos_, &sin_}) column->clear();
}

std::span<const SimdLevel> simd_levels() {
  static constexpr std::array<SimdLevel, 3> kLevels = {SimdLevel::baseline, SimdLevel::avx2,
                                                       SimdLevel::avx512};
  static const std::size_t count = count_levels();
  return {kLevels.data(), count};
}

void shortest_dubins_lengths(const PoseColumns& from, const PoseColumns& to, double radius_m,
                             std::span<double> lengths_m) {
  shortest_dubins_lengths(from, to, radius_m, lengths_m, simd_levels().back());
}

void shortest_dubins_lengths(const PoseColumns& from, const PoseColumns& to, double radius_m,
                             std::span<double> lengths_m, SimdLevel level) {
  SKEIN_ASSERT(radius_m > 0.0);
  SKEIN_ASSERT(static_cast<std::size_t>(level) < simd_levels().size());
  const std::size_t count = lengths_m.size();
  if (count == 0) return;
  const DubinsColumns a = pointers(from, count);
  const DubinsColumns b = pointers(to, count);
#if defined(__x86_64__)
  if (level == SimdLevel::avx512)
    return dubins_lengths_avx512(a, b, count, radius_m, lengths_m.data());
  if (level == SimdLevel::avx2) return dubins_lengths_avx2(a, b, count, radius_m, lengths_m.data());
#endif
  Baseline::lengths(a, b, count, radius_m, lengths_m.data());
}

}  // namespace skein::planning
