// SPDX-License-Identifier: Apache-2.0
#include "site_words.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>

#include "prompt_words.hpp"
#include "skein/base/angles.hpp"
#include "skein/wording/wording.hpp"

namespace skein::groundstation {
namespace {

using Words = std::vector<std::string_view>;

constexpr std::string_view kOptions =
    "at PLACE, like NAME, deliver BEARINGS, simultaneous, every S, assess N, wait S, dwell S, "
    "survey S, reward R, decay R, by ID, anyway";

/// "59.12N" as 59.12; nothing where the word does not end with one of the two letters.
std::optional<double> degrees_of(std::string_view word, char positive, char negative) {
  if (word.size() < 2 || (word.back() != positive && word.back() != negative)) return std::nullopt;
  const auto value = number_of(word.substr(0, word.size() - 1));
  if (!value || *value < 0.0) return std::nullopt;
  return word.back() == positive ? *value : -*value;
}

/// Works off the words of one order.
class SiteReader {
 public:
  explicit SiteReader(const Words& words) : words_{words} {}

  [[nodiscard]] bool done() const { return next_ == words_.size(); }
  [[nodiscard]] std::string_view peek() const { return words_[next_]; }
  std::string_view take() { return words_[next_++]; }

  /// EAST NORTH in metres, or latitude and longitude.
  Result<void> place(SiteWishes& into) {
    if (words_.size() - next_ < 2) {
      return Error{
          "a place is EAST NORTH in metres, as in '1200 -300', or a latitude and a "
          "longitude, as in '59.1234N 17.2345E'"};
    }
    const auto first = take();
    const auto second = take();
    const auto latitude = degrees_of(first, 'N', 'S');
    const auto longitude = degrees_of(second, 'E', 'W');
    if (latitude || longitude) {
      const bool good =
          latitude && longitude && kLatitude_deg.has(*latitude) && kLongitude_deg.has(*longitude);
      if (!good) {
        return Error{fmt::format("'{} {}' is no latitude and longitude, as in '59.1234N 17.2345E'",
                                 first, second)};
      }
      into.place = Wgs84{*latitude, *longitude, 0.0};
      into.place_m.reset();
      return {};
    }
    const auto east = number_after("EAST", first, kCoordinate_m);
    if (!east) return east.error();
    const auto north = number_after("EAST NORTH", second, kCoordinate_m);
    if (!north) return north.error();
    into.place_m = Vec2{*east, *north};
    into.place.reset();
    return {};
  }

  /// What follows the place, in any order.
  Result<void> option(SiteWishes& into) {
    const auto keyword = take();
    if (keyword == "at") return place(into);
    if ((keyword == "simultaneous" || keyword == "every") && into.interval_s) {
      return Error{
          "'simultaneous' and 'every S' each say when deliveries follow one another; give "
          "one of them, once"};
    }
    if (keyword == "simultaneous") {
      into.interval_s = 0.0;
      return {};
    }
    if (keyword == "anyway") {
      into.anyway = true;
      return {};
    }
    if (keyword == "like") return name(into);
    if (keyword == "deliver") return bearings(into);
    if (keyword == "by") return surveyor(into);
    if (keyword == "assess") {
      std::optional<double> count;
      auto read = number(keyword, kTasks, count);
      if (count) into.assessments = static_cast<int>(*count);
      return read;
    }
    struct Figure {
      std::string_view keyword;
      Limit limit;
      std::optional<double> SiteWishes::*of;
    };
    static constexpr std::array kFigures{
        Figure{"every", limit_of(configuration::kDeliveryInterval_s), &SiteWishes::interval_s},
        Figure{"wait", limit_of(configuration::kAssessmentWait_s), &SiteWishes::assessment_wait_s},
        Figure{"dwell", limit_of(configuration::kAssessmentDwell_s),
               &SiteWishes::assessment_dwell_s},
        Figure{"survey", limit_of(configuration::kSurveyDwell_s), &SiteWishes::survey_dwell_s},
        Figure{"reward", limit_of(configuration::kSiteReward), &SiteWishes::reward},
        Figure{"decay", limit_of(configuration::kRewardDecay_per_s),
               &SiteWishes::reward_decay_per_s}};
    for (const Figure& figure : kFigures) {
      if (figure.keyword == keyword) return number(keyword, figure.limit, into.*figure.of);
    }
    return Error{fmt::format("'{}' is none of {}", keyword, kOptions)};
  }

 private:
  Result<void> number(std::string_view keyword, const Limit& limit, std::optional<double>& value) {
    if (done()) return Error{fmt::format("'{}' needs a number after it", keyword)};
    const auto read = number_after(keyword, take(), limit);
    if (!read) return read.error();
    value = *read;
    return {};
  }

  Result<void> name(SiteWishes& into) {
    if (done()) return Error{"'like' needs the name of a template of the configuration"};
    into.like = take();
    return {};
  }

  Result<void> bearings(SiteWishes& into) {
    if (done()) {
      return Error{
          "'deliver' needs the compass bearings of the deliveries, as in 'deliver 090,180'; "
          "'deliver none' for none"};
    }
    std::string_view rest = take();
    into.bearings_rad.emplace();
    if (rest == "none") return {};
    while (true) {
      const auto comma = rest.find(',');
      const auto degrees = number_after("deliver", rest.substr(0, comma), kHeading_deg);
      if (!degrees) return degrees.error();
      into.bearings_rad->push_back(heading_from_compass_deg(*degrees));
      if (comma == std::string_view::npos) break;
      rest.remove_prefix(comma + 1);
    }
    if (into.bearings_rad->size() > kTasksPerKindMax) {
      return Error{fmt::format("a site has {} deliveries at most", kTasksPerKindMax)};
    }
    return {};
  }

  Result<void> surveyor(SiteWishes& into) {
    const auto vehicle = done() ? std::nullopt : id_of(take());
    if (!vehicle) return Error{"'by' needs the number of the vehicle that is to survey it"};
    into.surveyor = VehicleId{*vehicle};
    return {};
  }

  const Words& words_;
  std::size_t next_ = 1;
};

}  // namespace

Result<Input> site_order(const Words& words, bool preview) {
  NewSite order;
  order.preview = preview;
  SiteReader reader{words};
  if (words[0] == "change") {
    const auto site = words.size() > 3 && words[1] == "site" ? id_of(words[2]) : std::nullopt;
    if (!site) {
      return Error{
          "'change' needs the number of a site and what is to be otherwise, as in 'change "
          "site 10034 at 1250 -300 reward 5'"};
    }
    order.changes = SiteId{*site};
    reader.take();
    reader.take();
  } else if (reader.done()) {
    return Error{
        "'site' needs a place, as in 'site 1200 -300 deliver 090,180 simultaneous assess 2 "
        "reward 3' or 'site 59.1234N 17.2345E'; 'sites' lists those that are known"};
  } else if (reader.peek() != "like" && reader.peek() != "at") {
    if (const auto place = reader.place(order.wishes); !place) return place.error();
  }
  while (!reader.done()) {
    if (const auto read = reader.option(order.wishes); !read) return read.error();
  }
  if (!order.changes && !order.wishes.place_m && !order.wishes.place) {
    return Error{"'site like NAME' needs a place, as in 'site like NAME at 1200 -300'"};
  }
  return Input{std::move(order)};
}

Result<Input> withdrawal(const Words& words) {
  const auto number = words.size() == 3 ? id_of(words[2]) : std::nullopt;
  if (number && words[1] == "site") return Input{WithdrawSite{{*number}}};
  if (number && words[1] == "hazard") return Input{WithdrawHazard{{*number}}};
  if (number && words[1] == "decision") return Input{TakeBack{{*number}}};
  return Error{
      "'withdraw' needs what and its number, as in 'withdraw site 10034', 'withdraw hazard "
      "10051' or 'withdraw decision 3', of a site; "
      "'sites' and 'hazards' list them"};
}

Result<Input> proposal_answer(bool accept, const Words& words) {
  const auto number = words.size() == 2 ? id_of(words[1]) : std::nullopt;
  if (number) return Input{ProposalAnswer{*number, accept}};
  return Error{
      fmt::format("'{0}' needs the number of a proposal, as in '{0} 1'; 'proposals' lists "
                  "them",
                  words[0])};
}

std::string site_line(const NewSite& order) {
  const SiteWishes& wishes = order.wishes;
  std::string line = order.preview ? "preview " : "";
  auto out = std::back_inserter(line);
  if (order.changes) {
    fmt::format_to(out, "change site {}", order.changes->value);
  } else {
    line += "site";
  }
  if (!wishes.like.empty()) fmt::format_to(out, " like {}", wishes.like);
  if (wishes.place_m || wishes.place) {
    if (order.changes || !wishes.like.empty()) line += " at";
    if (wishes.place_m) {
      fmt::format_to(out, " {} {}", wishes.place_m->x(), wishes.place_m->y());
    } else {
      fmt::format_to(out, " {}{} {}{}", std::abs(wishes.place->latitude_deg),
                     wishes.place->latitude_deg < 0.0 ? "S" : "N",
                     std::abs(wishes.place->longitude_deg),
                     wishes.place->longitude_deg < 0.0 ? "W" : "E");
    }
  }
  if (wishes.bearings_rad) {
    line += " deliver ";
    if (wishes.bearings_rad->empty()) line += "none";
    const char* between = "";
    for (const double bearing_rad : *wishes.bearings_rad) {
      fmt::format_to(out, "{}{}", between, wording::bearing_digits(bearing_rad));
      between = ",";
    }
  }
  if (wishes.interval_s == 0.0) line += " simultaneous";
  if (wishes.interval_s.value_or(0.0) > 0.0) fmt::format_to(out, " every {}", *wishes.interval_s);
  if (wishes.assessments) fmt::format_to(out, " assess {}", *wishes.assessments);
  if (wishes.assessment_wait_s) fmt::format_to(out, " wait {}", *wishes.assessment_wait_s);
  if (wishes.assessment_dwell_s) fmt::format_to(out, " dwell {}", *wishes.assessment_dwell_s);
  if (wishes.survey_dwell_s) fmt::format_to(out, " survey {}", *wishes.survey_dwell_s);
  if (wishes.reward) fmt::format_to(out, " reward {}", *wishes.reward);
  if (wishes.reward_decay_per_s) fmt::format_to(out, " decay {}", *wishes.reward_decay_per_s);
  if (wishes.surveyor) fmt::format_to(out, " by {}", wishes.surveyor->value);
  if (wishes.anyway) line += " anyway";
  return line;
}

}  // namespace skein::groundstation
