// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/audit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <vector>

#include "skein/codec/json_text.hpp"
#include "skein/identity/authority.hpp"
#include "skein/identity/identity.hpp"

namespace skein::groundstation {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::int64_t kNow_unix_s = 1'777'000'000;

class AuditTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "skein-audit-XXXXXX";
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Of a new mission in that folder.
  [[nodiscard]] identity::Identity mission(const char* name) const {
    auto made =
        identity::Authority::create(folder_ / name, name, 30, kNow_unix_s, identity::Durable::no);
    EXPECT_TRUE(made.ok());
    auto opened = identity::Identity::open({folder_ / name, {}}, kNow_unix_s);
    EXPECT_TRUE(opened.ok());
    return std::move(opened).value();
  }
  [[nodiscard]] Audit open(const identity::Identity* by = nullptr) const {
    std::optional<AuditKey> key;
    if (by != nullptr) key = AuditKey{by->signer(), by->own(), {7}};
    auto opened = Audit::open(folder_.string(), key);
    EXPECT_TRUE(opened.ok());
    return std::move(opened).value();
  }
  static void add(Audit& audit, const std::string& line) {
    EXPECT_TRUE(audit.add({at_seconds(3.5), "ada", "console", line, true, "sent\nall"}).ok());
  }
  static void close(Audit& audit) { EXPECT_TRUE(audit.close(at_seconds(9.0), kNow_unix_s).ok()); }

  [[nodiscard]] std::vector<std::string> lines() const {
    std::ifstream file{folder_ / "audit.jsonl"};
    std::vector<std::string> all;
    for (std::string line; std::getline(file, line);) all.push_back(line);
    return all;
  }
  static std::string text_of(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    return text;
  }

  fs::path folder_;
};

TEST_F(AuditTest, ARunIsSignedAtItsEndAndTheNextGoesOn) {
  const auto ground = mission("ridge");
  {
    Audit audit = open(&ground);
    add(audit, "hold all");
    add(audit, "resume 2\x1b[2J");
    close(audit);
    close(audit);  // nothing since
  }
  Audit audit = open(&ground);
  EXPECT_THAT(audit.text(), HasSubstr("3.5 s  ada (console): hold all -> sent; all\n"));
  EXPECT_EQ(codec::parse_json(audit.json()).size(), 2U) << "the console shows what was before";
  add(audit, "return 3");
  EXPECT_EQ(codec::parse_json(audit.json()).back()["seq"], 3) << "2 is the signature";
  EXPECT_EQ(lines().size(), 4U);
  auto findings = verify_audit(text_of(lines()), &ground.authority());
  EXPECT_THAT(findings.faults, IsEmpty());
  EXPECT_EQ(findings.entries, 3U);
  EXPECT_EQ(findings.signatures, 1U);
  EXPECT_EQ(findings.after_signature, 1U);
  EXPECT_THAT(findings.remarks, ElementsAre(HasSubstr("no signature follows the last 1")));
  close(audit);
  findings = verify_audit(text_of(lines()), &ground.authority());
  EXPECT_TRUE(findings.good());
  EXPECT_THAT(findings.remarks, IsEmpty());
  EXPECT_THAT(verify_audit(text_of(lines()), nullptr).remarks,
              ElementsAre(HasSubstr("2 signatures are not checked")));
}

TEST_F(AuditTest, AnAnswerIsKeptWholeAndSaysWhatWasDoneInPart) {
  Audit audit = open();
  EXPECT_TRUE(audit
                  .add({at_seconds(4.0), "ada", "prompt", "hold 2,3", false,
                        "told to 2\nnot to 3: why\n", true})
                  .ok());
  const char* const shown = "hold 2,3 -> in part: told to 2; not to 3: why\n";
  EXPECT_THAT(audit.text(), HasSubstr(shown));
  EXPECT_THAT(open().text(), HasSubstr(shown)) << "of the file";
  EXPECT_TRUE(
      audit.add({at_seconds(5.0), "ada", "prompt", "sites f", true, std::string(9000, 'x')}).ok());
  EXPECT_LT(lines().back().size(), 1000U);
}

TEST_F(AuditTest, WhatIsChangedIsFound) {
  const auto ground = mission("ridge");
  Audit audit = open(&ground);
  for (const char* line : {"hold all", "resume all", "authorise 3", "return 2"}) add(audit, line);
  close(audit);
  const auto good = lines();
  ASSERT_TRUE(verify_audit(text_of(good), &ground.authority()).good());
  const auto faults = [&](const std::function<void(std::vector<std::string>&)>& change) {
    auto changed = good;
    change(changed);
    return verify_audit(text_of(changed), &ground.authority()).faults;
  };
  EXPECT_THAT(faults([](auto& all) { all[1].replace(all[1].find("resume"), 6, "RESUME"); }),
              ElementsAre(HasSubstr("line 3: the line before it was changed")));
  EXPECT_THAT(faults([](auto& all) { all.erase(all.begin() + 1); }),
              Contains(HasSubstr("line 2: the line before it was changed, or lines between")));
  EXPECT_THAT(faults([](auto& all) { all.erase(all.begin()); }),
              Contains(HasSubstr("line 1: lines before it are gone")));
  EXPECT_THAT(faults([](auto& all) { std::swap(all[0], all[1]); }), ::testing::Not(IsEmpty()));
  EXPECT_THAT(faults([](auto& all) { all.insert(all.begin() + 2, all[1]); }),
              ::testing::Not(IsEmpty()));
  // Who makes the chain anew after a change has not the key.
  EXPECT_THAT(faults([](auto& all) {
                std::string before = kNoLineBefore;
                for (std::string& line : all) {
                  auto json = codec::parse_own_json(line);
                  if (json.contains("line") && json["line"] == "authorise 3") json["who"] = "eve";
                  json["prev"] = before;
                  line = codec::json_text(json);
                  before = hash_of_line(line);
                }
              }),
              ElementsAre(HasSubstr("what was signed was changed since")));
  EXPECT_THAT(verify_audit(text_of({good.begin(), good.end() - 1}), &ground.authority()).remarks,
              ElementsAre(HasSubstr("no signature follows the last 4")));
}

TEST_F(AuditTest, ASignatureOfAnotherMissionIsNone) {
  const auto ground = mission("ridge");
  const auto other = mission("valley");
  Audit audit = open(&other);
  add(audit, "hold all");
  close(audit);
  EXPECT_EQ(verify_audit(text_of(lines()), &other.authority()).good_signatures, 1U);
  const auto findings = verify_audit(text_of(lines()), &ground.authority());
  EXPECT_TRUE(findings.good()) << "nobody has changed it";
  EXPECT_EQ(findings.good_signatures, 0U);
  EXPECT_EQ(findings.after_signature, 1U);
  EXPECT_THAT(findings.remarks, Contains(HasSubstr("line 2 was signed in another mission")));
}

TEST_F(AuditTest, WithoutTheSignaturesNothingIsProven) {
  const auto ground = mission("ridge");
  {
    Audit audit = open(&ground);
    add(audit, "hold all");
    close(audit);
  }
  // Who can write the file makes a chain of his own.
  std::vector<std::string> forged{lines().front()};
  forged[0].replace(forged[0].find("hold"), 4, "HOLD");
  const auto findings = verify_audit(text_of(forged), &ground.authority());
  EXPECT_TRUE(findings.good());
  EXPECT_EQ(findings.good_signatures, 0U);
  EXPECT_THAT(findings.remarks, ElementsAre(HasSubstr("no signature follows the last 1")));
}

TEST_F(AuditTest, WhatARunLeftUnsignedTheNextSigns) {
  const auto ground = mission("ridge");
  {
    Audit audit = open(&ground);
    add(audit, "hold all");  // and is killed
  }
  Audit audit = open(&ground);
  close(audit);
  const auto findings = verify_audit(text_of(lines()), &ground.authority());
  EXPECT_TRUE(findings.good());
  EXPECT_EQ(findings.after_signature, 0U);
}

TEST_F(AuditTest, ADateThatIsNoneIsNoSignature) {
  const auto ground = mission("ridge");
  Audit audit = open(&ground);
  add(audit, "hold all");
  EXPECT_TRUE(audit.close(at_seconds(9.0), std::numeric_limits<std::int64_t>::max()).ok());
  EXPECT_TRUE(verify_audit(text_of(lines()), &ground.authority()).good()) << "of a clock so wrong";
}

TEST_F(AuditTest, WhatCouldNotBeWrittenIsWrittenLater) {
  const auto ground = mission("ridge");
  Audit audit = open(&ground);
  add(audit, "hold all");
  const auto size = fs::file_size(folder_ / "audit.jsonl");
  ::rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto ignore = std::signal(SIGXFSZ, SIG_IGN);
  const ::rlimit full{.rlim_cur = size + 10, .rlim_max = before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &full), 0);
  EXPECT_FALSE(audit.add({at_seconds(4.0), "ada", "console", "resume all", true, "sent"}).ok());
  EXPECT_FALSE(audit.add({at_seconds(5.0), "ada", "console", "return 1", true, "sent"}).ok());
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  (void)std::signal(SIGXFSZ, ignore);
  add(audit, "return 2");
  close(audit);
  const auto findings = verify_audit(text_of(lines()), &ground.authority());
  EXPECT_THAT(findings.faults, IsEmpty());
  EXPECT_EQ(findings.entries, 4U);
  EXPECT_EQ(findings.after_signature, 0U);
  EXPECT_THAT(findings.remarks, ElementsAre(HasSubstr("line 2 was cut short")));
}

TEST_F(AuditTest, ALineThatWasCutShortIsToldAndTheRestHolds) {
  {
    Audit audit = open();
    add(audit, "hold all");
    add(audit, "resume all");
  }
  const auto file = folder_ / "audit.jsonl";
  fs::resize_file(file, fs::file_size(file) - 9);
  {
    Audit audit = open();
    add(audit, "return 2");
    close(audit);  // without a key
  }
  ASSERT_EQ(lines().size(), 3U);
  const auto findings = verify_audit(text_of(lines()), nullptr);
  EXPECT_THAT(findings.faults, IsEmpty());
  EXPECT_THAT(findings.remarks, Contains(HasSubstr("line 2 was cut short")));
  EXPECT_EQ(findings.signatures, 0U);
}

TEST_F(AuditTest, LinesOfTheFirstReleaseAreGoneOnWith) {
  std::ofstream{folder_ / "audit.jsonl"}
      << R"({"seq":0,"time_s":1.0,"who":"ada","from":"prompt","line":"hold all","done":true,"text":"sent"})"
      << "\n[1, 2]\n"
      << R"({"seq":"x","who":7,"time_s":1e300})"
      << "\n";
  {
    Audit audit = open();
    EXPECT_THAT(audit.text(), HasSubstr("1.0 s  ada (prompt): hold all -> sent"));
    add(audit, "resume all");
  }
  const auto findings = verify_audit(text_of(lines()), nullptr);
  EXPECT_TRUE(findings.good());
  EXPECT_THAT(findings.remarks, Contains(HasSubstr("of 0.1.0")));
}

}  // namespace
}  // namespace skein::groundstation
