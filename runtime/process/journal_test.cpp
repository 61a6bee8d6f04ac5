// SPDX-License-Identifier: Apache-2.0
#include "skein/process/journal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>

namespace skein::process {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Not;
using ::testing::StartsWith;

TEST(Journal, EveryKindOfEventHasItsOwnIdForGood) {
  std::set<std::string> ids;
  for (std::size_t i = 0; i < static_cast<std::size_t>(mission::EventKind::count); ++i) {
    const std::string id = message_id(static_cast<mission::EventKind>(i));
    EXPECT_EQ(id.size(), 32U);
    EXPECT_EQ(id[12], '5');
    EXPECT_TRUE(ids.insert(id).second);
  }
  // Searches and alarms elsewhere name it.
  EXPECT_EQ(message_id(mission::EventKind::site_detected), "ebbc70b0b80b5cda826b8ae23b06e479");
}

TEST(Journal, LinesHaveTheirFields) {
  EXPECT_THAT(journal_fields("hello", 6, at_seconds(1.5), nullptr),
              ElementsAre("MESSAGE=hello", "PRIORITY=6", "SKEIN_MISSION_TIME=1.500"));
  mission::MissionEvent event;
  event.vehicle = {7};
  event.task.site = {3};
  event.time = at_seconds(1.25);
  event.body = mission::event::SiteDetected{};
  const auto fields = journal_fields("a site", 6, at_seconds(1.5), &event);
  EXPECT_THAT(fields, Contains("SKEIN_EVENT=site_detected"));
  EXPECT_THAT(fields, Contains("SKEIN_VEHICLE=7"));
  EXPECT_THAT(fields, Contains("SKEIN_SITE=3"));
  EXPECT_THAT(fields, Contains("SKEIN_EVENT_TIME=1.250"));
  EXPECT_THAT(fields, Contains("MESSAGE_ID=" + message_id(event.kind())));
  event.task.site = {};
  EXPECT_THAT(journal_fields("", 6, {}, &event), Not(Contains(StartsWith("SKEIN_SITE"))));
}

TEST(Journal, KnowsItsStream) {
  struct stat file {};
  ASSERT_EQ(::fstat(0, &file), 0);
  const std::string name = std::to_string(file.st_dev) + ":" + std::to_string(file.st_ino);
  EXPECT_TRUE(is_journal(0, name));
  EXPECT_FALSE(is_journal(0, name + "0"));
  EXPECT_FALSE(is_journal(0, ""));
  EXPECT_FALSE(is_journal(-1, name));
}

TEST(Journal, ItsCatalogIsPrinted) {
  const std::string file = SKEIN_SOURCE_DIR "/packaging/systemd/skein.catalog";
  const std::string catalog = journal_catalog();
  // NOLINTNEXTLINE(concurrency-mt-unsafe): one thread
  if (std::getenv("SKEIN_UPDATE_DOCS") != nullptr) std::ofstream{file} << catalog;
  std::ifstream stream{file};
  const std::string kept{std::istreambuf_iterator<char>{stream}, {}};
  EXPECT_EQ(kept, catalog) << "run process_test with SKEIN_UPDATE_DOCS=1 to print " << file;
}

}  // namespace
}  // namespace skein::process
