// SPDX-License-Identifier: Apache-2.0
#include "rules.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <regex>
#include <string_view>

#include "functions.hpp"
#include "includes.hpp"
#include "text.hpp"

namespace skein::tidy {
namespace {

constexpr std::size_t kLinesMax = 800;
constexpr std::size_t kFunctionLinesMax = 70;

constexpr std::size_t kSpdxWithinLines = 3;

bool is_cpp(std::string_view path) { return path.ends_with(".cpp") || path.ends_with(".hpp"); }

bool is_cmake(std::string_view path) {
  return path.ends_with("CMakeLists.txt") || path.ends_with(".cmake");
}

bool is_source(std::string_view path) {
  return is_cpp(path) || is_cmake(path) || path.ends_with(".idl") || path.ends_with(".sh") ||
         path == "dev" || path == ".ci/run";
}

/// The rules themselves and their bad samples.
bool is_tidy(std::string_view path) { return path.starts_with("tests/tidy/"); }

/// What flies and decides: core without its tests.
bool is_core(std::string_view path) {
  return path.starts_with("core/") && is_cpp(path) && !path.ends_with("_test.cpp");
}

/// What does no input or output: core, the codes of DroneCAN and MAVLink, and what simulates
/// aircraft and their autopilots, without their tests.
bool is_pure(std::string_view path) {
  static constexpr std::array<std::string_view, 4> kPure{"hal/dronecan/", "hal/mavlink/",
                                                         "hal/models/", "hal/autopilot/"};
  const bool listed = std::ranges::any_of(
      kPure, [path](std::string_view folder) { return path.starts_with(folder); });
  return is_core(path) || (listed && is_cpp(path) && !path.ends_with("_test.cpp"));
}

/// The one source that speaks as ROS 2, in a program of its own.
bool is_ros_node(std::string_view path) { return path == "groundstation/ros2/ros_node.cpp"; }

bool is_cpp_outside_dds(std::string_view path) {
  return is_cpp(path) && !is_tidy(path) && !path.starts_with("runtime/network/") &&
         !path.starts_with("hil/radio/") && !is_ros_node(path) &&
         path != "tests/isolation/hostile_transport.cpp";
}

bool is_cpp_not_tidy(std::string_view path) { return is_cpp(path) && !is_tidy(path); }

/// dds_settings.cpp turns the list of the team's topics into QoS; nobody else has a word in it.
bool is_cpp_outside_settings(std::string_view path) {
  return is_cpp(path) && !is_tidy(path) && !is_ros_node(path) &&
         path != "runtime/network/dds_settings.cpp";
}

bool is_pure_but_assert(std::string_view path) {
  return is_pure(path) && path != "core/base/assert.cpp";  // its last words go to stderr
}

/// What decides, judges and counts, and what carries that: everything but its tests and the one
/// place where sentences are made.
bool reads_no_sentence(std::string_view path) {
  static constexpr std::array<std::string_view, 6> kOf{"core/",    "runtime/",       "hal/",
                                                       "onboard/", "groundstation/", "hil/"};
  return is_cpp(path) && !path.ends_with("_test.cpp") && !path.starts_with("runtime/wording/") &&
         std::ranges::any_of(kOf, [path](std::string_view of) { return path.starts_with(of); });
}

bool is_text_of_ours(std::string_view path) { return !is_tidy(path); }

/// A pattern that must match no line of the files that it applies to.
struct LineRule {
  enum class View { code, code_and_literals, everything };
  const char* name;
  bool (*applies)(std::string_view path);
  View view;
  const char* pattern;
  const char* message;
};

constexpr auto kCode = LineRule::View::code;

constexpr std::array kLineRules{
    LineRule{"core-clock", is_pure, kCode,
             R"(\b(system_clock|steady_clock|high_resolution_clock|utc_clock|clock_gettime)\b|)"
             R"(\b(gettimeofday|sleep_for|sleep_until|nanosleep|usleep)\b|\bstd::time\b|)"
             R"(#\s*include\s*<(ctime|time\.h|sys/time\.h)>)",
             "no clock here: take an Instant as an argument"},
    LineRule{"core-thread", is_pure, kCode,
             R"(\bstd::(thread|jthread|async|future|promise)\b|\b(this_thread|thread_local)\b|)"
             R"(\bpthread_|#\s*include\s*<(thread|future|stop_token|pthread\.h)>)",
             "no threads here: they belong to the processes (onboard, groundstation, hil)"},
    LineRule{"core-lock", is_pure, kCode,
             R"(\bstd::(\w*mutex|condition_variable\w*|\w+_lock|lock_guard|\w+_semaphore)\b|)"
             R"(#\s*include\s*<(mutex|shared_mutex|condition_variable|semaphore|latch|barrier)>)",
             "no locks here: the objects belong to one thread"},
    LineRule{"core-socket", is_pure, kCode,
             R"(\bsocket\s*\(|#\s*include\s*<(sys/|netinet/|arpa/|net/|linux/))"
             R"(|#\s*include\s*<(unistd|fcntl|poll|netdb)\.h>)",
             "no input or output here: hand messages in and out"},
    LineRule{"core-output", is_pure_but_assert, kCode,
             R"(\bstd::(cout|cerr|clog|cin)\b|\b(printf|fprintf|puts|fputs|fopen|getenv)\s*\(|)"
             R"(#\s*include\s*<(iostream|fstream|filesystem|print)>)",
             "no input or output here: return the text, or a Result with the reason"},
    LineRule{"core-random", is_pure, kCode,
             R"(\b(s?rand|rand_r|drand48)\s*\(|\b(random_device|mt19937\w*|minstd_rand0?)\b|)"
             R"(\bdefault_random_engine\b|#\s*include\s*<random>)",
             "take a seeded skein::Random as an argument (skein/base/random.hpp)"},
    LineRule{"core-unordered", is_pure, kCode, R"(\bunordered_(multi)?(map|set)\b)",
             "its order differs between libraries: use std::map, std::set or a sorted vector"},
    LineRule{"core-throw", is_pure, kCode, R"(\bthrow\b)",
             "return a Result with the reason; a broken invariant is SKEIN_ASSERT"},
    LineRule{"core-library", is_core, kCode,
             R"(#\s*include\s*<(?!Eigen/|GeographicLib/|sys/|netinet/|arpa/|net/|linux/)[^>]*/)",
             "core depends on the standard library, Eigen and GeographicLib only"},
    LineRule{"dds-outside", is_cpp_outside_dds, LineRule::View::code_and_literals,
             R"(#\s*include\s*[<"](fastdds|fastrtps|fastcdr)/|\beprosima::)",
             "DDS stays in runtime/network/, hil/radio/ and ROS 2's node: use their interfaces"},
    LineRule{"qos-outside", is_cpp_outside_settings, kCode,
             R"(\b(RELIABLE_RELIABILITY|BEST_EFFORT_RELIABILITY|TRANSIENT_LOCAL_DURABILITY|)"
             R"(VOLATILE_DURABILITY|KEEP_LAST_HISTORY|KEEP_ALL_HISTORY)_QOS\b)",
             "a topic's name, type and QoS are one entry of idl/topics.json"},
    LineRule{"topic-name", is_cpp_not_tidy, LineRule::View::code_and_literals,
             R"x("(rt/)?skein/[a-z_]+")x",
             "a topic's name, type and QoS are one entry of idl/topics.json"},
    // A comparison of a `detail`, of an error's message or of what wording makes; and of anything
    // with a literal of several words.
    LineRule{
        "sentence", reads_no_sentence, LineRule::View::code_and_literals,
        R"(\b(detail|message|sentence)\b(\(\))?\s*(==|!=)(?!\s*nullptr)|)"
        R"((==|!=)\s*[A-Za-z_][\w.>()-]*(\.|->)(detail|message|sentence)\b|)"
        R"(\b(detail|message|sentence)(\(\))?\.(r?find\w*|\w+s_with|compare|contains|substr)\(|)"
        R"(\bwording::\w+\([^;"]*\)\s*(==|!=|\.(r?find|\w+s_with|compare|contains|substr)))"
        R"(|(==|!=)\s*"[^" ]+ [^"]*[a-z]"|"[^" ]+ [^"]*[a-z]"\s*(==|!=))"
        R"(|\b(r?find|\w+s_with|compare|contains)\(\s*"[^" ]+ [^"]*[a-z]")",
        "nobody decides on a sentence: give what you need to know a field of its own"},
    LineRule{"unfinished", is_text_of_ours, LineRule::View::everything,
             R"(\b(TODO|FIXME|XXX|HACK)\b)", "finish it, or open an issue and say what is missing"},
    LineRule{"machine-path", is_text_of_ours, LineRule::View::everything,
             R"((^|[^\w./*-])/(home|root|mnt|media|srv|Users|work\w*|var/tmp)/)",
             "a path of one machine: name files from the root of the repository"},
};

/// Words, or neighbouring words, that no name in the code may hold (docs/scope.md).
constexpr std::array kOutOfScope{
    "weapon",          "weapons",
    "munition",        "munitions",
    "warhead",         "fuze",
    "missile",         "bomb",
    "seeker",          "strike",
    "attack",          "enemy",
    "lethal",          "release payload",
    "payload release", "release load",
    "drop payload",    "drop load",
    "payload drop",    "detect person",
    "detect people",   "track person",
    "track people",    "follow person",
    "follow people",   "person detector",
    "people detector", "face detector",
    "target lock",
};

class Checker {
 public:
  explicit Checker(const std::vector<File>& files) {
    for (const File& file : files) {
      if (file.path.ends_with("CMakeLists.txt")) {
        const std::size_t name = file.path.rfind("CMakeLists.txt");
        cmake_lists_[file.path.substr(0, name)] = without_cmake_comments(file.text);
      }
    }
    patterns_.reserve(kLineRules.size());
    for (const LineRule& rule : kLineRules) {
      patterns_.emplace_back(rule.pattern, std::regex::ECMAScript | std::regex::optimize);
    }
  }

  void check(const File& file) {
    file_ = &file;
    const bool cpp = is_cpp(file.path) || file.path.ends_with(".idl");
    const auto everything = lines_of(file.text);
    const auto literals = cpp ? lines_of(without_comments(file.text, Literals::keep)) : everything;
    const auto code = cpp ? lines_of(without_comments(file.text, Literals::blank)) : everything;
    check_lines(code, literals, everything);
    check_scope(literals);
    check_file(everything);
    if (is_cpp(file.path)) check_functions(without_comments(file.text, Literals::blank));
  }

  /// Between files, and between modules: folders with a CMakeLists.txt of their own. What a test
  /// includes is not a need of its module.
  void check_includes(const std::vector<File>& files) {
    std::map<std::string, std::string> code;
    for (const File& file : files) {
      if (is_cpp(file.path)) code[file.path] = without_comments(file.text, Literals::keep);
    }
    const Graph includes = includes_of(code);
    Graph needs;
    for (const auto& [path, included] : includes) {
      if (path.ends_with("_test.cpp")) continue;
      for (const std::string& other : included) {
        if (module_of(path) != module_of(other)) needs[module_of(path)].insert(module_of(other));
      }
    }
    report_cycles(cycles_of(includes), "they include each other: part what both need from them");
    report_cycles(cycles_of(needs), "modules need each other: part what both need from them");
  }

  [[nodiscard]] std::vector<Finding> take() { return std::move(findings_); }

 private:
  void report(std::size_t line, std::string rule, std::string message) {
    findings_.push_back({file_->path, line, std::move(rule), std::move(message)});
  }

  void report_cycles(const std::vector<std::vector<std::string>>& cycles, const char* message) {
    for (const auto& cycle : cycles) {
      std::string way;
      for (const std::string& node : cycle) way += (way.empty() ? "" : " -> ") + node;
      findings_.push_back({cycle.front(), 1, "cycle", way + ": " + message});
    }
  }

  void check_functions(const std::string& code) {
    for (const Function& function : functions_of(code)) {
      const std::size_t lines = function.last - function.first + 1;
      if (lines <= kFunctionLinesMax || function.name.empty()) continue;  // or a table
      report(function.first, "long-function",
             function.name + " has " + std::to_string(lines) + " lines, the limit is " +
                 std::to_string(kFunctionLinesMax) + ": give its steps names");
    }
  }

  void check_lines(const std::vector<std::string>& code, const std::vector<std::string>& literals,
                   const std::vector<std::string>& everything) {
    for (std::size_t r = 0; r < kLineRules.size(); ++r) {
      const LineRule& rule = kLineRules.at(r);
      if (!rule.applies(file_->path)) continue;
      const auto& lines = rule.view == kCode                        ? code
                          : rule.view == LineRule::View::everything ? everything
                                                                    : literals;
      for (std::size_t i = 0; i < lines.size(); ++i) {
        std::smatch match;
        if (!std::regex_search(lines[i], match, patterns_[r])) continue;
        report(i + 1, rule.name, "'" + match.str() + "': " + rule.message);
      }
    }
  }

  /// Names in code, and in the strings of it because these become keys and commands; not comments,
  /// nor docs, which may say what is out of scope.
  void check_scope(const std::vector<std::string>& lines) {
    const bool applies = is_source(file_->path) || file_->path.ends_with(".yaml");
    if (!applies || is_tidy(file_->path)) return;
    static const std::regex identifier{R"([A-Za-z_]\w*)"};
    for (std::size_t i = 0; i < lines.size(); ++i) {
      for (std::sregex_iterator it{lines[i].begin(), lines[i].end(), identifier}, end; it != end;
           ++it) {
        const std::string words = " " + words_of(it->str()) + " ";
        const bool out = std::any_of(kOutOfScope.begin(), kOutOfScope.end(), [&](const char* w) {
          return words.find(" " + std::string{w} + " ") != std::string::npos;
        });
        if (out) report(i + 1, "scope", "'" + it->str() + "' is out of scope: see docs/scope.md");
      }
    }
  }

  void check_file(const std::vector<std::string>& lines) {
    const std::string& path = file_->path;
    static const std::regex vague{R"((^|/|_)(utils?|common|managers?|helpers?|misc)(/|_|\.))"};
    if (is_source(path) && std::regex_search(path, vague)) {
      report(1, "vague-name", "name the file after the one thing that it holds");
    }
    if (is_cpp(path) && lines.size() > kLinesMax) {
      report(kLinesMax + 1, "too-long",
             std::to_string(lines.size()) + " lines, the limit is " + std::to_string(kLinesMax) +
                 ": two concepts share this file, part them");
    }
    if (is_source(path)) {
      const auto head =
          lines.begin() + static_cast<std::ptrdiff_t>(std::min(lines.size(), kSpdxWithinLines));
      const bool has = std::any_of(lines.begin(), head, [](const std::string& line) {
        return line.find("SPDX-License-Identifier: Apache-2.0") != std::string::npos;
      });
      if (!has) report(1, "spdx", "begin with a comment 'SPDX-License-Identifier: Apache-2.0'");
    }
    if (is_cpp(path) && !is_in_a_target(path)) {
      report(1, "no-target", "no CMakeLists.txt above it names this file: add it to a target");
    }
  }

  /// Named, relative to it, in a CMakeLists.txt of its folder or of one above?
  [[nodiscard]] bool is_in_a_target(const std::string& path) const {
    static constexpr std::string_view kBefore = " \t\n(\"/";
    static constexpr std::string_view kAfter = " \t\n)\"";
    for (const auto& [folder, text] : cmake_lists_) {
      if (!path.starts_with(folder)) continue;
      const std::string name = path.substr(folder.size());
      for (std::size_t at = text.find(name); at != std::string::npos;
           at = text.find(name, at + 1)) {
        const std::size_t end = at + name.size();
        const bool starts = at == 0 || kBefore.find(text[at - 1]) != std::string_view::npos;
        const bool ends = end == text.size() || kAfter.find(text[end]) != std::string_view::npos;
        if (starts && ends) return true;
      }
    }
    return false;
  }

  /// The deepest folder with a CMakeLists.txt that the file lies in.
  [[nodiscard]] std::string module_of(const std::string& path) const {
    std::string module;
    for (const auto& [folder, text] : cmake_lists_) {
      if (path.starts_with(folder) && folder.size() > module.size()) module = folder;
    }
    return module;
  }

  std::map<std::string, std::string> cmake_lists_;  ///< by folder, with a '/' at its end
  std::vector<std::regex> patterns_;                ///< of kLineRules
  const File* file_ = nullptr;
  std::vector<Finding> findings_;
};

}  // namespace

std::vector<Finding> check(const std::vector<File>& files) {
  Checker checker{files};
  for (const File& file : files) checker.check(file);
  checker.check_includes(files);
  return checker.take();
}

}  // namespace skein::tidy
