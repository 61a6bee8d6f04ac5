// SPDX-License-Identifier: Apache-2.0
#include "rules.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "functions.hpp"
#include "includes.hpp"
#include "text.hpp"

namespace skein::tidy {
namespace {

constexpr const char* kSpdx = "// SPDX-License-Identifier: Apache-2.0\n";

/// The findings in one file that a target names and that begins as it should.
std::vector<Finding> findings_in(const std::string& path, const std::string& text) {
  return check({{"CMakeLists.txt", "# SPDX-License-Identifier: Apache-2.0\nx(" + path + ")\n"},
                {path, kSpdx + text}});
}

/// A bad line, where it stands, and a line that resembles it and is allowed.
struct Sample {
  const char* rule;
  const char* path;
  const char* bad;
  const char* good;
};

class LineRules : public testing::TestWithParam<Sample> {};

TEST_P(LineRules, FireOnTheBadLineAndNotOnTheGoodOne) {
  const Sample& s = GetParam();
  const auto found = findings_in(s.path, std::string{"\n"} + s.bad + "\n");
  ASSERT_EQ(found.size(), 1U) << s.bad;
  EXPECT_EQ(found[0].rule, s.rule);
  EXPECT_EQ(found[0].path, s.path);
  EXPECT_EQ(found[0].line, 3U);
  EXPECT_FALSE(found[0].message.empty());
  const auto none = findings_in(s.path, s.good);
  EXPECT_TRUE(none.empty()) << s.good << "\n" << none[0].rule << ": " << none[0].message;
}

constexpr const char* kCore = "core/planning/dubins.cpp";
constexpr const char* kOnboard = "onboard/agent_loop.cpp";

INSTANTIATE_TEST_SUITE_P(
    Each, LineRules,
    testing::Values(
        Sample{"core-clock", kCore, "auto t = std::chrono::steady_clock::now();",
               "// steady_clock is not for us\nstd::chrono::nanoseconds d{};"},
        Sample{"core-clock", kCore, "#include <ctime>", "#include <chrono>"},
        Sample{"core-clock", kCore, "std::this_time(); sleep_for(d);", "double time(int);"},
        Sample{"core-clock", "hal/dronecan/node.cpp", "auto t = std::chrono::steady_clock::now();",
               "Instant now;"},
        Sample{"core-socket", "hal/mavlink/parser.cpp", "#include <sys/socket.h>",
               "#include <nettle/sha2.h>"},
        Sample{"core-thread", kCore, "#include <thread>", "#include <string>"},
        Sample{"core-thread", kCore, "std::jthread worker;", "int thread = 0;"},
        Sample{"core-lock", kCore, "std::mutex m;", "bool mutex_free = true;"},
        Sample{"core-lock", kCore, "#include <condition_variable>", "#include <variant>"},
        Sample{"core-lock", kCore, "std::scoped_lock lock{m};", "void lock();"},
        Sample{"core-socket", kCore, "int s = socket(AF_INET, SOCK_DGRAM, 0);", "int socket = 0;"},
        Sample{"core-socket", kCore, "#include <sys/socket.h>", "#include <system_error>"},
        Sample{"core-output", kCore, "#include <iostream>", "#include <sstream>"},
        Sample{"core-output", kCore, "printf(\"x\");", "std::snprintf(b, n, \"%f\", x);"},
        Sample{"core-random", kCore, "int r = rand();", "int operand();"},
        Sample{"core-random", kCore, "std::random_device seed;", "Random random{seed};"},
        Sample{"core-unordered", kCore, "std::unordered_map<int, int> m;", "std::map<int, int> m;"},
        Sample{"core-throw", kCore, "throw 1;", "return Error{\"a throw of dice\"};"},
        Sample{"core-library", kCore, "#include <yaml-cpp/yaml.h>", "#include <Eigen/Core>"},
        Sample{"dds-outside", kOnboard, "#include <fastdds/dds/topic/Topic.hpp>",
               "#include \"skein/network/participant.hpp\"\n// eprosima::fastdds is elsewhere"},
        Sample{"dds-outside", kCore, "eprosima::fastrtps::Time_t t;", "int eprosima = 0;"},
        Sample{"qos-outside", "runtime/network/participant.cpp",
               "q.reliability().kind = RELIABLE_RELIABILITY_QOS;", "q = topic.qos;"},
        Sample{"topic-name", kOnboard, "subscribe(\"skein/telemetry\");",
               "#include \"skein/network/node.hpp\"\nsubscribe(Topic::telemetry);"},
        Sample{"sentence", kCore, "return why.detail == \"too late\";",
               "event.detail = \"too late\";"},
        Sample{"sentence", kCore, "if (said_ != again.error().message) tell();",
               "if (message != nullptr) tell(again.error().message);"},
        Sample{"sentence", "hil/checks/excuses.cpp",
               "if (text.starts_with(\"may have been flown\")) n++;",
               "if (option.starts_with(\"--\")) n++;"},
        Sample{"sentence", "hil/simulator/run.cpp", "return kHeld != \"the plan is held\";",
               "return std::string{\"the plan is held\"};"},
        Sample{"sentence", kOnboard, "if (wording::text_of(event) == last_) return;",
               "last_ = wording::text_of(event);"},
        Sample{"sentence", "groundstation/desk.cpp", "at = error.message.find(':');",
               "say(error.message + \": \");"},
        Sample{"unfinished", "docs/a.md", "TODO: the rest", "what is left to do"},
        Sample{"unfinished", kOnboard, "// FIXME", "// fixme not"},
        Sample{"machine-path", "docs/a.md", "see /home/ann/skein/notes", "see docs/home/notes"},
        Sample{"machine-path", kOnboard, "open(\"/var/tmp/x\");", "open(\"/var/lib/x\");"},
        Sample{"scope", kOnboard, "void release_payload();", "bool released = payload.size();"},
        Sample{"scope", "idl/mission.idl", "boolean fuzeArmed;", "boolean refused;"},
        Sample{"scope", "scenarios/a.yaml", "weapon: 1", "load: 1"},
        Sample{"scope", kOnboard, "parse(\"drop_load\");", "// says that we never drop_load"}),
    [](const auto& sample) { return std::to_string(sample.index); });

TEST(Rules, CoreRulesLeaveTestsAndOtherFoldersAlone) {
  EXPECT_TRUE(findings_in("core/planning/dubins_test.cpp", "#include <random>").empty());
  EXPECT_TRUE(findings_in(kOnboard, "#include <mutex>").empty());
  EXPECT_TRUE(
      findings_in("runtime/network/participant.cpp", "#include <fastdds/dds/Topic.hpp>").empty());
}

TEST(Rules, OnlyTheNodeOfRos2HasDdsBesideTheNetwork) {
  const char* const include = "#include <fastdds/dds/Topic.hpp>";
  const char* const qos = "auto k = KEEP_LAST_HISTORY_QOS;";
  EXPECT_TRUE(findings_in("groundstation/ros2/ros_node.cpp", include).empty());
  EXPECT_TRUE(findings_in("groundstation/ros2/ros_node.cpp", qos).empty());
  EXPECT_EQ(findings_in("groundstation/ros2/bridge.cpp", include).size(), 1U);
  EXPECT_EQ(findings_in("groundstation/ros2/bridge.cpp", qos).size(), 1U);
}

TEST(Rules, SentencesAreForTestsAndTheirOwnModule) {
  const char* const line = "EXPECT(event.detail == \"too late\");";
  EXPECT_TRUE(findings_in("core/mission/agent_test.cpp", line).empty());
  EXPECT_TRUE(findings_in("runtime/wording/wording.cpp", line).empty());
  EXPECT_EQ(findings_in("core/mission/agent.cpp", line).size(), 1U);
}

TEST(Rules, QosIsSetByTheNode) {
  EXPECT_TRUE(
      findings_in("runtime/network/dds_settings.cpp", "auto k = KEEP_LAST_HISTORY_QOS;").empty());
}

TEST(Rules, SourceMustBeginWithItsLicence) {
  const auto found = check({{"CMakeLists.txt", "x(a.cpp)"}, {"a.cpp", "int a;\n"}});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].rule, "spdx");
  EXPECT_EQ(found[1].rule, "spdx");
}

TEST(Rules, FileMustBeNamedAfterWhatItHolds) {
  const auto found = findings_in("runtime/network/socket_utils.cpp", "");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].rule, "vague-name");
  EXPECT_TRUE(findings_in("runtime/network/commons.cpp", "").empty());
}

TEST(Rules, SourceMustNotBeTooLong) {
  std::string text;
  for (int i = 0; i < 799; ++i) text += "int a;\n";
  EXPECT_TRUE(findings_in("a.cpp", text).empty());
  const auto found = findings_in("a.cpp", text + "int a;\n");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].rule, "too-long");
}

TEST(Rules, FunctionMustNotBeTooLong) {
  std::string text = "int f() {\n";
  for (int i = 0; i < 68; ++i) text += "  g();\n";
  EXPECT_TRUE(findings_in("a.cpp", text + "}\n").empty());
  const auto found = findings_in("a.cpp", text + "  g();\n}\n");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].rule, "long-function");
  EXPECT_EQ(found[0].line, 2U) << "where it begins, not where it is too long";
}

TEST(Rules, FilesAndModulesMustNotNeedEachOther) {
  const auto cycles_with = [](const std::string& of_a, const std::string& of_b,
                              const std::string& name_of_b) {
    const std::string targets = "# SPDX-License-Identifier: Apache-2.0\nx(b.cpp b_test.cpp)\n";
    const auto found =
        check({{"a/CMakeLists.txt", targets + "x(include/skein/a/a.hpp include/skein/a/a2.hpp)"},
               {"a/include/skein/a/a.hpp", kSpdx + of_a},
               {"a/include/skein/a/a2.hpp", kSpdx},
               {"b/CMakeLists.txt", targets + "x(include/skein/b/b.hpp)"},
               {"b/" + name_of_b, kSpdx + of_b},
               {"b/include/skein/b/b.hpp", kSpdx}});
    std::string all;
    for (const Finding& f : found)
      all += f.rule + " " + f.message.substr(0, f.message.find(':')) + "\n";
    return all;
  };
  EXPECT_EQ(cycles_with("#include \"skein/a/a2.hpp\"\n", "#include \"skein/a/a.hpp\"\n", "b.cpp"),
            "");
  EXPECT_EQ(cycles_with("#include \"skein/b/b.hpp\"\n", "#include \"skein/a/a2.hpp\"\n", "b.cpp"),
            "cycle a/ -> b/ -> a/\n");
  EXPECT_EQ(
      cycles_with("#include \"skein/b/b.hpp\"\n", "#include \"skein/a/a2.hpp\"\n", "b_test.cpp"),
      "");
  EXPECT_EQ(cycles_with("#include \"a.hpp\"\n", "", "b.cpp"),
            "cycle a/include/skein/a/a.hpp -> a/include/skein/a/a.hpp\n");
}

TEST(Includes, AreFoundBesideTheirFileAndInIncludeFolders) {
  const Graph graph = includes_of(
      {{"m/x.cpp", "#include \"x.hpp\"\n # include  \"skein/m/y.hpp\"\n#include \"no.hpp\""},
       {"m/x.hpp", "int s = f(\"x.cpp\");"},
       {"m/include/skein/m/y.hpp", ""}});
  EXPECT_EQ(graph.at("m/x.cpp"), (std::set<std::string>{"m/include/skein/m/y.hpp", "m/x.hpp"}));
  EXPECT_TRUE(graph.at("m/x.hpp").empty());
}

TEST(Includes, CyclesAreToldInTheirOrder) {
  using Cycles = std::vector<std::vector<std::string>>;
  EXPECT_EQ(cycles_of({{"a", {"b", "c"}}, {"b", {"c"}}, {"c", {}}}), Cycles{});
  EXPECT_EQ(cycles_of({{"a", {"b"}}, {"b", {"c"}}, {"c", {"b"}}}), (Cycles{{"b", "c", "b"}}));
}

/// "name first-last" of each function.
std::string functions_in(const std::string& text) {
  std::string all;
  for (const Function& f : functions_of(without_comments(text, Literals::blank))) {
    all += f.name + " " + std::to_string(f.first) + "-" + std::to_string(f.last) + "\n";
  }
  return all;
}

TEST(Functions, AreFoundInNamespacesAndClasses) {
  EXPECT_EQ(functions_in("int f();\nint f() {\n  if (a) { g(); }\n  return 1;\n}\nint b;\n"),
            "f 2-5\n");
  EXPECT_EQ(
      functions_in("namespace a::b {\nvoid A::f() const {\n}\n}\nextern \"C\" {\nvoid g() {}\n}\n"),
      "A::f 2-3\ng 6-6\n");
  EXPECT_EQ(functions_in("class A final : public B<int> {\n public:\n  A() {}\n private:\n  void "
                         "f() {\n  }\n  int a_{1};\n};"),
            "A 3-3\nf 5-6\n");
  EXPECT_EQ(functions_in("enum class E { a, b };\nstruct alignas(8) S {\n  ~S() {}\n};"),
            "~S 3-3\n");
}

TEST(Functions, InitialisersAndDefaultsAreNotTakenForBodies) {
  EXPECT_EQ(functions_in("A::A(int a)\n    : a_{a},\n      b_{f(), 1} {\n}\n"), "A::A 1-4\n");
  EXPECT_EQ(functions_in("A::A(int a) : a_(a), b_{} {}\nA::A() : A{1} {}\n"),
            "A::A 1-1\nA::A 2-2\n");
  EXPECT_EQ(functions_in("std::array a{B{\n1}};\nint c = f({1, 2});\nS s = {1,\n 2};\n"), "");
  EXPECT_EQ(functions_in("void f(S s = {}, T t = T{1}) {\n}\n"), "f 1-2\n");
}

TEST(Functions, TemplatesOperatorsAndLambdasOfVariables) {
  EXPECT_EQ(functions_in("template <class T = std::vector<int>>\n  requires(C<T>)\n[[nodiscard]] "
                         "auto f(T t)\n    -> A<T> {\n}\n"),
            "f 1-5\n");
  EXPECT_EQ(functions_in("bool A::operator==(const A& a) const {\n}\nint operator()(int a) {\n}\n"),
            "A::operator_ 1-2\noperator_ 3-4\n");
  EXPECT_EQ(
      functions_in("const auto f = [](int a) {\n  g();\n};\nconst int k = [] {\n return 1; }();\n"),
      "f 1-3\nk 4-5\n");
  EXPECT_EQ(functions_in("#define F(a) \\\n  void a() {\nvoid g() {\n}\n"), "g 3-4\n");
}

TEST(Rules, SourceMustBelongToATarget) {
  const auto rules_with = [](const std::string& cmake, const std::string& path) {
    const auto found = check(
        {{"hal/CMakeLists.txt", "# SPDX-License-Identifier: Apache-2.0\n" + cmake}, {path, kSpdx}});
    return found.empty() ? std::string{} : found[0].rule;
  };
  EXPECT_EQ(rules_with("skein_module(hal SOURCES can/bus.cpp)", "hal/can/bus.cpp"), "");
  EXPECT_EQ(rules_with("skein_module(hal SOURCES can/bus.cpp)", "hal/bus.cpp"), "")
      << "a folder before the name may come from a variable";
  EXPECT_EQ(rules_with("skein_module(hal SOURCES can_bus.cpp)", "hal/bus.cpp"), "no-target");
  EXPECT_EQ(rules_with("# can/bus.cpp", "hal/can/bus.cpp"), "no-target");
  EXPECT_EQ(rules_with("skein_module(hal SOURCES bus.cpp)", "runtime/network/bus.cpp"),
            "no-target");
}

TEST(Text, CommentsAndLiteralsAreBlankedInPlace) {
  EXPECT_EQ(without_comments("a // b\nc", Literals::keep), "a     \nc");
  EXPECT_EQ(without_comments("a /* b\nb */ c", Literals::keep), "a     \n     c");
  EXPECT_EQ(without_comments("f(\"// \\\" x\") y", Literals::keep), "f(\"// \\\" x\") y");
  EXPECT_EQ(without_comments("f(\"// \\\" x\") y", Literals::blank), "f(         ) y");
  EXPECT_EQ(without_comments("1'000 + x // 'c'", Literals::blank), "1'000 + x       ");
  EXPECT_EQ(without_comments("R\"(a\"b)\" c", Literals::blank), "R        c");
}

TEST(Text, WordsOfIdentifiers) {
  EXPECT_EQ(words_of("releasePayload_2"), "release payload 2");
  EXPECT_EQ(words_of("kLinesMax"), "k lines max");
  EXPECT_EQ(words_of("members_"), "members ");
}

}  // namespace
}  // namespace skein::tidy
