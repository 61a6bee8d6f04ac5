// SPDX-License-Identifier: Apache-2.0
#include "skein/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "charts.hpp"
#include "formation_charts.hpp"
#include "page_script.hpp"
#include "skein/report/drawing.hpp"
#include "skein/report/palette.hpp"
#include "story.hpp"
#include "style.hpp"
#include "truth_table.hpp"

namespace skein::report {
namespace {

using checks::CheckResult;

constexpr std::size_t kSentencesMax = 25;

/// A picture that answers to a pointer (page_script.hpp).
std::string plot(const std::string& svg) {
  return svg.empty() ? "" : "<figure class=\"plot\">" + svg + "</figure>";
}

/// For the part of an address behind its #.
std::string percent_encoded(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '.' || c == '_';
    out += plain ? std::string{c} : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}

std::string verdict(const std::vector<CheckResult>& checks) {
  const auto failed =
      std::count_if(checks.begin(), checks.end(), [](const CheckResult& c) { return !c.held(); });
  if (failed == 0) {
    return fmt::format(R"~(<div class="verdict pass-word"><b>PASS</b>all {} checks held</div>)~",
                       checks.size());
  }
  return fmt::format(
      R"~(<div class="verdict fail-word"><b>FAIL</b>{} of {} checks did not hold</div>)~", failed,
      checks.size());
}

std::string comparison_table(const Contents& contents) {
  std::string html =
      "<table><thead><tr><th></th><th>ours</th><th>published</th></tr></thead><tbody>";
  SiteId last{};
  bool first = true;
  for (const ComparisonRow& row : contents.comparison) {
    if (first || row.site != last) {
      html += fmt::format(
          R"~(<tr class="site"><td colspan="3"><span class="dot" style="background:var(--s{})"></span>site {}</td></tr>)~",
          colour_of(contents.record, row.site), row.site.value);
    }
    first = false;
    last = row.site;
    html += fmt::format(R"~(<tr><td class="soft">{}</td><td>{}</td><td>{}</td></tr>)~",
                        escaped(row.what), escaped(row.ours), escaped(row.published));
  }
  return html + "</tbody></table>";
}

/// Where a check looks when it has nothing to point at.
Instant begin_of(const checks::RunRecord& record) {
  Instant begin = Instant::max();
  for (const auto& recorded : record.recordings) {
    if (!recorded.track.empty()) begin = std::min(begin, recorded.track.front().state.time);
  }
  return begin == Instant::max() ? Instant{} : begin;
}

Instant moment_of(const CheckResult& check, const checks::RunRecord& record) {
  const auto timed = std::ranges::find_if(
      check.violations, [](const checks::Violation& v) { return v.time != Instant{}; });
  if (timed != check.violations.end()) return timed->time;
  return check.moment.value_or(begin_of(record));
}

/// A moment of the mission as a link into its replay, with the command line that opens it.
std::string link_to(const Contents& contents, Instant moment) {
  const std::string seconds = fmt::format("{:.1f}", to_seconds(moment));
  if (contents.replay.empty() || contents.replay_url.empty()) return seconds + " s";
  return fmt::format(
      R"~(<a class="moment" target="_blank" rel="noopener" href="{}#seek={}&amp;of={}" data-command="{} --at {}" title="Opens where the replay runs; copies what starts it">{} s</a>)~",
      escaped(contents.replay_url), seconds, percent_encoded(contents.run),
      escaped(contents.replay), seconds, seconds);
}

std::string sentence(const Contents& contents, const checks::Violation& violation,
                     std::string_view before) {
  return fmt::format("<li>{}{} {}</li>", before, escaped(violation.sentence),
                     violation.time == Instant{} ? "" : link_to(contents, violation.time));
}

std::string sentences(const Contents& contents, const CheckResult& check) {
  std::string html = R"~(<tr class="sentences"><td colspan="7"><ul>)~";
  for (std::size_t i = 0; i < std::min(kSentencesMax, check.violations.size()); ++i) {
    html += sentence(contents, check.violations[i], "");
  }
  if (check.violations.size() > kSentencesMax) {
    html += fmt::format("<li>and {} more</li>", check.violations.size() - kSentencesMax);
  }
  for (const auto& excused : check.excused) {
    html += sentence(contents, excused, "excused: ");
  }
  return html + "</ul></td></tr>";
}

std::string check_table(const Contents& contents) {
  std::string html =
      "<table><thead><tr><th></th><th>check</th><th>rule</th><th class=\"number\">judged</th>"
      "<th>measured</th><th>when</th><th class=\"number\">violations</th></tr></thead><tbody>";
  for (const CheckResult& check : contents.checks) {
    html += fmt::format(
        R"~(<tr><td class="{}">{}</td><td>{}</td><td class="soft">{}</td><td class="number">{} {}</td><td>{}</td><td>{}</td><td class="number">{}</td></tr>)~",
        check.held() ? "pass-word" : "fail-word", check.held() ? "held" : "FAILED",
        escaped(check.name), escaped(check.requirement), check.judged, escaped(check.judged_what),
        escaped(check.measured), link_to(contents, moment_of(check, contents.record)),
        check.violations.size());
    if (!check.held() || !check.excused.empty()) html += sentences(contents, check);
  }
  return html + "</tbody></table>";
}

std::string formation_section(const Contents& contents) {
  if (contents.record.places.empty()) return "";
  std::string html =
      "<h2>Distance of the two nearest vehicles</h2><p>Dashed: the limit. Shaded: a formation "
      "holds.</p><div class=\"wide\">" +
      plot(separation_chart(contents.record, contents.limits)) +
      "</div>\n<h2>Distance from the places</h2><p>Dashed: the limit of the root mean square. A "
      "line each vehicle.</p><div class=\"wide\">" +
      plot(place_chart(contents.record, contents.limits)) +
      "</div>\n<h2>Formations from above</h2><p>Rings: the places. Lines: what was flown while the "
      "formation held.</p><div class=\"many\">";
  for (const auto& [title, picture] : formation_pictures(contents.record)) {
    html += fmt::format("<section><h3>{}</h3>\n{}</section>\n", escaped(title), plot(picture));
  }
  return html + "</div>\n";
}

std::string hindsight_section(const Contents& contents) {
  if (contents.hindsight.empty()) return "";
  std::string html =
      "<h2>Knowing all from the start</h2><p>What somebody could have flown with these vehicles "
      "who "
      "knew every site and hazard when the mission began, without searching, radio or operator. "
      "Bound: no plan is better.</p><div class=\"wide\"><table><thead><tr><th></th>"
      "<th class=\"number\">flown</th><th class=\"number\">best found</th>"
      "<th class=\"number\">bound</th><th class=\"number\">flown / best</th></tr></thead><tbody>";
  for (const hindsight::Row& row : contents.hindsight) {
    html += fmt::format(
        R"~(<tr><td>{}</td><td class="number">{}</td><td class="number">{}</td><td class="number">{}</td><td class="number">{}</td></tr>)~",
        escaped(row.what), escaped(row.flown), escaped(row.best), escaped(row.bound),
        escaped(row.ratio));
  }
  return html + "</tbody></table></div>\n";
}

std::string truth_section(const Contents& contents) {
  const TruthTable table = truth_table(contents.record, contents.limits);
  if (table.rows.empty()) return "";
  std::string html =
      "<h2>Planned, believed, true</h2><p>Of aircraft in a simulator: how far from its plan each "
      "believed it was and really was; root mean square / most. Of copters in formation: how far "
      "each believed it was from its place, in place, moving in level flight, and climbing or "
      "sinking.</p><div class=\"wide\"><table>"
      "<thead><tr>";
  for (const std::string& cell : table.head) html += "<th>" + escaped(cell) + "</th>";
  html += "</tr></thead><tbody>";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (const std::string& cell : row) html += "<td>" + escaped(cell) + "</td>";
    html += "</tr>";
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace

std::string html(const Contents& contents) {
  const std::vector<Story> told = stories(contents.record);
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">"
      "<meta name=\"color-scheme\" content=\"light dark\">"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'; script-src 'unsafe-inline'\">";
  page += fmt::format("<title>{}</title><style>{}{}{}</style></head><body>\n",
                      escaped(contents.title), kPalette, kDrawing, kPage);
  page += fmt::format("<header><div><h1>{}</h1><p>{}</p></div>{}</header>\n",
                      escaped(contents.title), escaped(contents.summary), verdict(contents.checks));
  if (!contents.replay.empty()) {
    page += fmt::format(
        R"~(<p>See it again, any moment of it: <code>{0}</code> <button type="button" data-command="{0}">Copy</button></p>)~"
        "\n",
        escaped(contents.replay));
  }
  page += "<div class=\"two\"><section><h2>Flown tracks</h2>\n";
  page += plot(map(contents.record, told, "", ""));
  page += "</section>";
  if (!contents.comparison.empty()) {
    page += "<section><h2>Ours beside the published mission</h2>\n" + comparison_table(contents) +
            "</section>";
  }
  page += "</div>\n" + formation_section(contents);
  page += hindsight_section(contents);
  page += truth_section(contents);
  page +=
      "<h2>Checks</h2><p>Each time is a link into the replay: it opens there where the replay runs "
      "at its usual address, and copies the command line that starts it.</p><div class=\"wide\">" +
      check_table(contents) + "</div>\n";

  std::string curves;
  for (const Site& site : contents.record.sites) {
    const std::string chart = distance_curves(contents.record, contents.limits, told, site);
    if (chart.empty()) continue;
    curves += fmt::format("<section><h3>Site {}</h3>\n{}</section>\n", site.id.value, plot(chart));
  }
  if (!curves.empty()) {
    page +=
        "<h2>Distance of every member from its site</h2><p>From its award to the end of its task. "
        "Solid: delivers. Dashed: assesses. Ring: pass over the site.</p><div class=\"many\">" +
        curves + "</div>\n";
  }
  if (!told.empty()) {
    page +=
        "<h2>Time line</h2><p>The number at the start of a flight is that of the site.</p>"
        "<div class=\"wide\">" +
        plot(time_line(contents.record, told)) + "</div>\n";
  }
  const std::string flown = errors(contents.record, contents.limits);
  if (!flown.empty()) {
    page +=
        "<h2>Flown against planned</h2><p>The band is what is allowed.</p><div class=\"wide\">" +
        plot(flown) + "</div>\n";
  }
  page += "<div id=\"tip\" hidden></div><div id=\"said\" role=\"status\" hidden></div>\n<script>";
  return page.append(kScript) + "</script></body></html>\n";
}

std::string mission_svg(const checks::RunRecord& record) {
  const std::string style = fmt::format("<style>{}{}</style>", kPalette, kDrawing);
  return map(record, stories(record), R"~(xmlns="http://www.w3.org/2000/svg" width="900")~", style);
}

}  // namespace skein::report
