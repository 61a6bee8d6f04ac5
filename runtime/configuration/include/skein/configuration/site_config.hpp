// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/domain/site.hpp"

namespace skein::configuration {

/// Between which figures one of a site is taken, in files and in orders.
struct SiteLimit {
  double low = 0.0;
  double high = 0.0;
};
inline constexpr SiteLimit kSurveyDwell_s{1.0, 3600.0};
inline constexpr SiteLimit kDeliveryInterval_s{0.0, 3600.0};
inline constexpr SiteLimit kAssessmentWait_s{0.0, 3600.0};
inline constexpr SiteLimit kAssessmentDwell_s{1.0, 3600.0};
inline constexpr SiteLimit kSiteReward{0.0, 1e9};
inline constexpr SiteLimit kRewardDecay_per_s{0.0, 10.0};

/// What is to be done at a site of some kind; neither number nor position are read.
struct SiteTemplate {
  std::string name;
  Site site;
};

/// What becomes of a detection on board, at the ground station.
enum class DetectionMode : std::uint8_t { propose, take, count };

struct DetectionsConfig {
  DetectionMode mode = DetectionMode::propose;
  double same_site_m = 30.0;  ///< nearer to each other two reports are of one site
};

/// A file of sites for the ground station, which gives them their numbers.
struct SitesFile {
  std::string title;
  std::vector<Site> sites;
};

/// Fails with one line for every mistake in the file: "file:line: key: what is wrong; what to do".
[[nodiscard]] Result<SitesFile> load_sites(const std::filesystem::path& file);
/// As above, from text; `name` stands for the file in messages.
[[nodiscard]] Result<SitesFile> parse_sites(std::string_view yaml, const std::string& name);
/// What load_sites reads back as the same struct.
[[nodiscard]] std::string to_yaml(const SitesFile& file);

}  // namespace skein::configuration
