// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/arrival.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"
#include "skein/planning/dubins.hpp"
#include "transit_lengths.hpp"

namespace skein::planning {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kExact_m = 5e-7;
constexpr double kGapStep_m = 1e-3;  ///< to which the end of a gap is found
constexpr int kSamples = 24;         ///< of a family of paths, between which roots are sought
constexpr int kBisections = 60;
constexpr double kBendMax_rad = radians(85.0);
/// Farther apart than so many radii, no turning circles at both ends are within 4 radii.
constexpr double kNoGap_radii = 6.0;

constexpr std::array<DubinsWord, 4> kCscWords = {DubinsWord::LSL, DubinsWord::LSR, DubinsWord::RSL,
                                                 DubinsWord::RSR};
constexpr std::array<DubinsWord, 2> kCccWords = {DubinsWord::RLR, DubinsWord::LRL};

/// How unpleasant a path is to fly, in radians of turning: what it turns, and how far it strays
/// from the line between its ends, a turn radius counting as a radian.
double discomfort(const Path& path, const Pose2& to, double radius_m) {
  const double chord = (to.position() - path.start.position()).norm();
  double turned = 0.0;
  double strays = 0.0;
  Pose2 pose = path.start;
  for (const Segment& piece : path.segments) {
    turned += std::abs(piece.curvature_per_m) * piece.length_m;
    for (int quarter = 0; quarter < 4; ++quarter) {
      pose = advance(pose, piece.curvature_per_m, piece.length_m / 4.0);
      const double farther = std::max((pose.position() - path.start.position()).norm(),
                                      (pose.position() - to.position()).norm());
      strays = std::max(strays, farther - chord);
    }
  }
  return turned + strays / radius_m;
}

/// Lengths that cannot be flown, as far as it is known.
struct Unflyable {
  double from_m;
  double below_m;              ///< to here
  double above_m = kInfinity;  ///< this one can
  int scans = 0;
  bool without_end = false;

  [[nodiscard]] bool is_settled() const { return without_end || above_m - below_m <= kGapStep_m; }
  /// None from from_m on can be flown that is less.
  [[nodiscard]] double end_m() const {
    if (without_end) return kInfinity;
    return is_settled() ? above_m : below_m;
  }
  [[nodiscard]] bool has(double length_m) const {
    if (length_m < from_m) return false;
    return is_settled() ? length_m < end_m() : length_m <= below_m + kExact_m;
  }
};

/// One request: the shortest clear path, and the search for longer ones.
class Search {
 public:
  Search(const Transit& transit, const Path& shortest)
      : transit_{transit}, shortest_{shortest}, shortest_m_{shortest.length_m()} {
    find_bases();
  }

  [[nodiscard]] double shortest_m() const { return shortest_m_; }
  /// Independent of length_max_m.
  [[nodiscard]] std::optional<Path> find(double length_m);
  /// Does find give a path? Any will do, and what is quick to try is tried first.
  [[nodiscard]] bool reaches(double length_m);
  /// One step towards the least length above the gap that can be flown, up to `limit_m`.
  void narrow(Unflyable& gap, double limit_m);

 private:
  void find_bases();
  void begin(double length_m);
  void consider(const Path& path);
  [[nodiscard]] bool done() const { return any_will_do_ && best_; }
  void larger_radii();
  void unequal_radii();
  void bends();
  void loops();
  void leads();
  void lead(double curvature_per_m, bool at_start);
  template <class Family>
  void solve(double low, double high, bool geometric, const Family& family);

  Transit transit_;
  Path shortest_;
  double shortest_m_;
  std::vector<Path> bases_;  ///< clear paths of the least radius, to be lengthened

  double wanted_m_ = 0.0;
  bool any_will_do_ = false;
  std::optional<Path> best_;
  double best_discomfort_ = kInfinity;
};

void Search::find_bases() {
  bases_.push_back(shortest_);
  const auto add = [&](const std::optional<DubinsPath>& word) {
    if (!word || word->length_m() <= shortest_m_ + kExact_m) return;
    const Path path = word->to_path();
    if (is_clear(path, transit_.hazards)) bases_.push_back(path);
  };
  for (const DubinsWord word : kCscWords) {
    add(dubins_word(word, transit_.from, transit_.to, transit_.radius_m, transit_.radius_m));
  }
  for (const DubinsWord word : kCccWords) {
    add(dubins_ccc(word, transit_.from, transit_.to, transit_.radius_m, false));
    add(dubins_ccc(word, transit_.from, transit_.to, transit_.radius_m, true));
  }
}

void Search::consider(const Path& path) {
  if (done() || std::abs(path.length_m() - wanted_m_) > kExact_m) return;
  const double value = any_will_do_ ? 0.0 : discomfort(path, transit_.to, transit_.radius_m);
  if (value >= best_discomfort_) return;
  if (!is_clear(path, transit_.hazards)) return;
  best_ = path;
  best_discomfort_ = value;
}

/// Every member of a one-parameter family of Dubins paths that has the wanted length: sign changes
/// between samples, then bisection. A jump of the length has a sign change too, and is refused by
/// consider().
template <class Family>
void Search::solve(double low, double high, bool geometric, const Family& family) {
  const auto parameter = [&](double i) {
    const double part = i / kSamples;
    return geometric ? low * std::pow(high / low, part) : low + (high - low) * part;
  };
  const auto excess = [&](const std::optional<DubinsPath>& p, double extra) {
    return p->length_m() + extra - wanted_m_;
  };
  std::optional<double> before;
  for (int i = 0; i <= kSamples && !done(); ++i) {
    const auto [path, extra] = family.at(parameter(i));
    const std::optional<double> value = path ? std::optional{excess(path, extra)} : std::nullopt;
    if (before && value && (*before <= 0.0) != (*value <= 0.0)) {
      double below = i - 1;
      double above = i;
      double at = below;
      double miss = *before;
      for (int k = 0; k < kBisections && std::abs(miss) > 1e-9; ++k) {
        at = (below + above) / 2.0;
        const auto [middle, middle_extra] = family.at(parameter(at));
        if (!middle) break;
        miss = excess(middle, middle_extra);
        ((miss <= 0.0) == (*before <= 0.0) ? below : above) = at;
      }
      if (std::abs(miss) <= kExact_m) {
        if (const auto whole = family.path(parameter(at))) consider(*whole);
      }
    }
    before = value;
  }
}

struct Sample {
  std::optional<DubinsPath> path;
  double extra_m = 0.0;
};

/// One word flown with a larger radius.
struct WiderWord {
  DubinsWord word = DubinsWord::LSL;
  bool major = false;
  const Transit& transit;
  bool widen_start = true;
  bool widen_end = true;

  [[nodiscard]] Sample at(double radius_m) const {
    if (word == DubinsWord::RLR || word == DubinsWord::LRL) {
      return {dubins_ccc(word, transit.from, transit.to, radius_m, major)};
    }
    return {dubins_word(word, transit.from, transit.to, widen_start ? radius_m : transit.radius_m,
                        widen_end ? radius_m : transit.radius_m)};
  }
  [[nodiscard]] std::optional<Path> path(double radius_m) const {
    const auto dubins = at(radius_m).path;
    return dubins ? std::optional{dubins->to_path()} : std::nullopt;
  }
};

void Search::larger_radii() {
  // Beyond this radius an arc is too flat to add what consider() could tell from the shortest.
  const double widest_m = std::max(20.0 * wanted_m_, 4.0 * transit_.radius_m);
  for (const DubinsWord word : kCscWords) {
    solve(transit_.radius_m, widest_m, true, WiderWord{word, false, transit_});
  }
  for (const DubinsWord word : kCccWords) {
    solve(transit_.radius_m, widest_m, true, WiderWord{word, false, transit_});
    solve(transit_.radius_m, widest_m, true, WiderWord{word, true, transit_});
  }
}

void Search::unequal_radii() {
  const double widest_m = std::max(2.0 * wanted_m_, 4.0 * transit_.radius_m);
  for (const DubinsWord word : kCscWords) {
    solve(transit_.radius_m, widest_m, true, WiderWord{word, false, transit_, true, false});
    solve(transit_.radius_m, widest_m, true, WiderWord{word, false, transit_, false, true});
  }
}

/// In place of a straight line of length s: turn away by `angle`, back through twice that, and
/// away again, with two lines between. Its length grows steadily with the angle.
struct Bend {
  double angle_rad;
  double line_m;
};

/// The largest angle of a bend in place of a line of that length.
double bend_angle_max_rad(double straight_m, double radius_m) {
  return straight_m >= 4.0 * radius_m * std::sin(kBendMax_rad)
             ? kBendMax_rad
             : std::asin(straight_m / (4.0 * radius_m));
}

double bend_length_m(double straight_m, double radius_m, double angle_rad) {
  const double line_m = std::max(
      0.0, (straight_m - 4.0 * radius_m * std::sin(angle_rad)) / (2.0 * std::cos(angle_rad)));
  return 4.0 * radius_m * angle_rad + 2.0 * line_m;
}

std::optional<Bend> bend_of_length(double straight_m, double radius_m, double length_m) {
  double low = 0.0;
  double high = bend_angle_max_rad(straight_m, radius_m);
  if (bend_length_m(straight_m, radius_m, high) < length_m) return std::nullopt;
  for (int k = 0; k < kBisections; ++k) {
    const double middle = (low + high) / 2.0;
    (bend_length_m(straight_m, radius_m, middle) < length_m ? low : high) = middle;
  }
  return Bend{high, (length_m - 4.0 * radius_m * high) / 2.0};
}

/// The path with its piece `index` replaced.
std::optional<Path> with_piece(const Path& base, std::size_t index,
                               std::span<const Segment> pieces) {
  Path path{.start = base.start, .segments = {}};
  bool fits = true;
  for (std::size_t i = 0; i < base.segments.size(); ++i) {
    if (i != index) {
      fits = fits && path.append(base.segments[i]);
      continue;
    }
    for (const Segment& piece : pieces) fits = fits && path.append(piece);
  }
  return fits ? std::optional{path} : std::nullopt;
}

void Search::bends() {
  const double r = transit_.radius_m;
  for (const Path& base : bases_) {
    const double extra = wanted_m_ - base.length_m();
    if (extra < 0.0 || done()) continue;
    for (std::size_t i = 0; i < base.segments.size(); ++i) {
      const Segment& piece = base.segments[i];
      if (piece.curvature_per_m != 0.0) continue;
      const auto bend = bend_of_length(piece.length_m, r, piece.length_m + extra);
      if (!bend) continue;
      for (const double side : {1.0, -1.0}) {
        const Segment away{side / r, r * bend->angle_rad};
        const Segment back{-side / r, 2.0 * r * bend->angle_rad};
        const Segment line{0.0, bend->line_m};
        const std::array<Segment, 5> pieces = {away, line, back, line, away};
        if (const auto path = with_piece(base, i, pieces)) consider(*path);
      }
    }
  }
}

void Search::loops() {
  const double r = transit_.radius_m;
  for (const Path& base : bases_) {
    const double extra = wanted_m_ - base.length_m();
    const int most = static_cast<int>(std::min(64.0, std::floor(extra / (kTwoPi * r) + 1e-12)));
    for (int count = 1; count <= most && !done(); ++count) {
      const double circle_m = extra / count;
      const double radius_m = std::max(r, circle_m / kTwoPi);
      for (const double side : {1.0, -1.0}) {
        const Segment loop{side / radius_m, circle_m * count};
        // Before each piece, and at the end.
        for (std::size_t i = 0; i <= base.segments.size(); ++i) {
          Path path{.start = base.start, .segments = {}};
          bool fits = true;
          for (std::size_t k = 0; k < base.segments.size(); ++k) {
            if (k == i) fits = fits && path.append(loop);
            fits = fits && path.append(base.segments[k]);
          }
          if (i == base.segments.size()) fits = fits && path.append(loop);
          if (fits) consider(path);
        }
      }
    }
  }
}

/// A piece of constant curvature before or after a word.
struct LedWord {
  DubinsWord word = DubinsWord::LSL;
  bool major = false;
  const Transit& transit;
  double curvature_per_m = 0.0;
  bool at_start = true;

  [[nodiscard]] Sample at(double lead_m) const {
    const Pose2 from = at_start ? advance(transit.from, curvature_per_m, lead_m) : transit.from;
    const Pose2 to = at_start ? transit.to : advance(transit.to, curvature_per_m, -lead_m);
    if (word == DubinsWord::RLR || word == DubinsWord::LRL) {
      return {dubins_ccc(word, from, to, transit.radius_m, major), lead_m};
    }
    return {dubins_word(word, from, to, transit.radius_m, transit.radius_m), lead_m};
  }
  [[nodiscard]] std::optional<Path> path(double lead_m) const {
    const auto dubins = at(lead_m).path;
    if (!dubins) return std::nullopt;
    const Segment piece{curvature_per_m, lead_m};
    Path whole{.start = transit.from, .segments = {}};
    const bool fits = at_start ? whole.append(piece) && whole.append(dubins->to_path())
                               : whole.append(dubins->to_path()) && whole.append(piece);
    return fits ? std::optional{whole} : std::nullopt;
  }
};

void Search::lead(double curvature_per_m, bool at_start) {
  const double longest_m =
      curvature_per_m == 0.0 ? wanted_m_ : std::min(wanted_m_, kTwoPi * transit_.radius_m);
  for (const DubinsWord word : kCscWords) {
    solve(0.0, longest_m, false, LedWord{word, false, transit_, curvature_per_m, at_start});
  }
  for (const DubinsWord word : kCccWords) {
    solve(0.0, longest_m, false, LedWord{word, false, transit_, curvature_per_m, at_start});
    solve(0.0, longest_m, false, LedWord{word, true, transit_, curvature_per_m, at_start});
  }
}

void Search::leads() {
  const double tightest = 1.0 / transit_.radius_m;
  for (const bool at_start : {true, false}) {
    for (const double curvature : {0.0, tightest, -tightest}) lead(curvature, at_start);
  }
}

void Search::begin(double length_m) {
  wanted_m_ = length_m;
  best_.reset();
  best_discomfort_ = kInfinity;
  for (const Path& base : bases_) consider(base);
}

bool Search::reaches(double length_m) {
  if (length_m <= shortest_m_ + kExact_m) return length_m >= shortest_m_ - kExact_m;
  any_will_do_ = true;
  begin(length_m);
  bends();
  loops();
  larger_radii();
  unequal_radii();
  leads();
  any_will_do_ = false;
  return best_.has_value();
}

std::optional<Path> Search::find(double length_m) {
  if (length_m < shortest_m_ - kExact_m) return std::nullopt;
  if (length_m <= shortest_m_ + kExact_m) return shortest_;
  begin(length_m);
  larger_radii();
  bends();
  loops();
  if (!best_) unequal_radii();
  if (!best_) leads();
  return best_;
}

void Search::narrow(Unflyable& gap, double limit_m) {
  // A gap is no longer than one loop, but for hazards.
  constexpr int kScansMax = 96;
  const double step_m = kTwoPi * transit_.radius_m / 24.0;
  if (gap.above_m < kInfinity) {
    const double middle = (gap.below_m + gap.above_m) / 2.0;
    (reaches(middle) ? gap.above_m : gap.below_m) = middle;
    return;
  }
  gap.without_end = gap.scans++ == kScansMax || gap.below_m >= limit_m;
  if (gap.without_end) return;
  const double next_m = std::min(gap.below_m + step_m, limit_m);
  if (!reaches(next_m)) {
    gap.below_m = next_m;
    return;
  }
  gap.above_m = next_m;
  // The end of a gap is often the length of a word itself; hit it exactly.
  for (const Path& base : bases_) {
    const double exact = base.length_m();
    if (exact > gap.below_m && exact < gap.above_m && reaches(exact)) gap.above_m = exact;
  }
}

/// For what follows the way out of the hazards around the start. `shortest` must outlive it.
Search search_for(const Transit& transit, const ClearPath& shortest) {
  return {Transit{shortest.path.start, transit.to, transit.radius_m, transit.length_max_m,
                  shortest.circles},
          shortest.path};
}

std::string metres(double m) {
  const auto tenths = std::llround(m * 10.0);
  return std::to_string(tenths / 10) + "." + std::to_string(std::abs(tenths % 10)) + " m";
}

Error out_of_range(double length_m, double length_max_m) {
  return Error{"A path of " + metres(length_m) + " exceeds the range left of " +
               metres(length_max_m)};
}

}  // namespace

std::optional<double> least_without_hazards(const AvoidanceParams& params, const Transit& transit,
                                            double shortest_m, double length_m) {
  const double least_m = std::max(length_m, shortest_m);
  if (!out_of_reach(params, transit.from, transit.to, least_m, transit.hazards)) {
    return std::nullopt;
  }
  const double r = transit.radius_m;
  if (least_m <= shortest_m + kExact_m || least_m >= shortest_m + kTwoPi * r) return least_m;
  // The turning circles of no side can be within 4 radii.
  const double apart_m = kNoGap_radii * r;
  if ((transit.to.position() - transit.from.position()).squaredNorm() > apart_m * apart_m) {
    return least_m;
  }
  const auto gap = length_gap(transit.from, transit.to, r);
  if (!gap || least_m <= gap->low_m || least_m >= gap->high_m) return least_m;
  if (!out_of_reach(params, transit.from, transit.to, gap->high_m, transit.hazards)) {
    return std::nullopt;
  }
  return gap->high_m;
}

Result<Path> path_of_length(const AvoidanceParams& params, const Transit& transit,
                            double length_m) {
  SKEIN_ASSERT(transit.radius_m > 0.0);
  if (!std::isfinite(length_m)) return Error{"The wanted length is not a number"};
  if (length_m > transit.length_max_m + kExact_m) {
    return out_of_range(length_m, transit.length_max_m);
  }
  const auto shortest =
      find_clear_path(params, transit.from, transit.to, transit.radius_m, transit.hazards);
  if (!shortest) return shortest.error();
  const double out_m = shortest->way_out.length_m();
  Search search = search_for(transit, *shortest);
  if (const auto path = search.find(length_m - out_m)) {
    Path whole = shortest->way_out;
    if (whole.append(*path)) return whole;
  }
  if (length_m < out_m + search.shortest_m()) {
    return Error{"No path of " + metres(length_m) + ": the shortest is " +
                 metres(out_m + search.shortest_m())};
  }
  const auto next = least_length_from(params, transit, length_m + kGapStep_m);
  const std::string none = "No path of " + metres(length_m) + " was found";
  if (!next) return Error{none + ", nor a longer one within " + metres(transit.length_max_m)};
  constexpr double kShown_m = 0.1;  // two lengths nearer than that read as the same
  return Error{*next - length_m < kShown_m
                   ? none + "; there is one that is less than " + metres(kShown_m) + " longer"
                   : none + "; the next longer one is " + metres(*next)};
}

std::optional<LengthGap> length_gap(const Pose2& from, const Pose2& to, double radius_m) {
  const DubinsPath shortest = shortest_dubins(from, to, radius_m);
  if (shortest.word == DubinsWord::RLR || shortest.word == DubinsWord::LRL) return std::nullopt;
  double low_m = 0.0;
  for (const DubinsWord word : kCccWords) {
    const auto wave = dubins_ccc(word, from, to, radius_m, false);
    if (!wave) return std::nullopt;
    low_m = std::max(low_m, wave->length_m());
  }
  const double shortest_m = shortest.length_m();
  double high_m = shortest_m + kTwoPi * radius_m;
  const auto take = [&](const std::optional<DubinsPath>& word) {
    if (word && word->length_m() > shortest_m + kExact_m) {
      high_m = std::min(high_m, word->length_m());
    }
  };
  for (const DubinsWord word : kCscWords) take(dubins_word(word, from, to, radius_m, radius_m));
  for (const DubinsWord word : kCccWords) take(dubins_ccc(word, from, to, radius_m, true));
  if (high_m <= low_m + kExact_m) return std::nullopt;
  return LengthGap{low_m, high_m};
}

bool surely_flyable(const AvoidanceParams& params, const Transit& transit, double shortest_m,
                    double length_m) {
  if (!(length_m >= shortest_m) || length_m > transit.length_max_m + kExact_m) return false;
  const auto least_m = least_without_hazards(params, transit, shortest_m, length_m);
  return least_m && *least_m <= length_m;
}

struct TransitLengths::Found {
  Found(const Transit& transit, ClearPath way)
      : shortest{std::move(way)},
        search{search_for(transit, shortest)},
        out_m{shortest.way_out.length_m()},
        least_m{out_m + search.shortest_m()} {}

  ClearPath shortest;
  Search search;  ///< beyond the way out
  double out_m;
  double least_m;
  std::optional<Unflyable> gap;  ///< the last that was met
};

TransitLengths::TransitLengths(const Transit& transit, ClearPath shortest)
    : length_max_m_{transit.length_max_m},
      found_{std::make_unique<Found>(transit, std::move(shortest))} {}
TransitLengths::TransitLengths(TransitLengths&&) noexcept = default;
TransitLengths& TransitLengths::operator=(TransitLengths&&) noexcept = default;
TransitLengths::~TransitLengths() = default;

double TransitLengths::none_before_m(double length_m, bool exactly) {
  auto& [shortest, search, out_m, least_m, gap] = *found_;
  const double wanted_m = std::max(length_m, least_m);
  if (wanted_m > length_max_m_ + kExact_m) return kInfinity;
  const double beyond_m = wanted_m - out_m;
  if (!gap || !gap->has(beyond_m)) {
    if (search.reaches(beyond_m)) return wanted_m;
    if (gap && beyond_m > gap->below_m && beyond_m < gap->above_m) {
      gap->below_m = beyond_m;
    } else {
      gap = Unflyable{beyond_m, beyond_m};
    }
  }
  while (!gap->is_settled() && (exactly || gap->end_m() <= beyond_m + kExact_m)) {
    search.narrow(*gap, length_max_m_ - out_m);
  }
  return out_m + gap->end_m();
}

Result<double> TransitLengths::least_from(double length_m) {
  const double wanted_m = std::max(length_m, found_->least_m);
  if (wanted_m > length_max_m_ + kExact_m) return out_of_range(wanted_m, length_max_m_);
  const double least_m = none_before_m(length_m, true);
  if (least_m < kInfinity) return least_m;
  return Error{"No path of " + metres(length_m) + " or longer was found within " +
               metres(length_max_m_)};
}

Result<double> least_length_from(const AvoidanceParams& params, const Transit& transit,
                                 double length_m) {
  SKEIN_ASSERT(transit.radius_m > 0.0);
  if (!std::isfinite(length_m)) return Error{"The wanted length is not a number"};
  const double direct_m = shortest_dubins_length(transit.from, transit.to, transit.radius_m);
  if (const auto least_m = least_without_hazards(params, transit, direct_m, length_m)) {
    if (*least_m <= transit.length_max_m + kExact_m) return *least_m;
    return out_of_range(*least_m, transit.length_max_m);
  }
  auto shortest =
      find_clear_path(params, transit.from, transit.to, transit.radius_m, transit.hazards);
  if (!shortest) return shortest.error();
  return TransitLengths{transit, std::move(*shortest)}.least_from(length_m);
}

}  // namespace skein::planning
