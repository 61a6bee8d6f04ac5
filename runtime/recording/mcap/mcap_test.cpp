// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "crc32.hpp"
#include "skein/base/random.hpp"
#include "skein/mcap/cursor.hpp"
#include "skein/mcap/reader.hpp"
#include "skein/mcap/writer.hpp"

namespace skein::mcap {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Bytes = std::vector<std::uint8_t>;

constexpr std::uint64_t kSecond = 1'000'000'000;

Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

class McapTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("skein-mcap-" + std::to_string(::getpid()) + "-" +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
    file_ = folder_ / "a.mcap";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] Writer open(Compression compression = Compression::zstd) const {
    WriterOptions options;
    options.profile = "ros2";
    options.library = "test";
    options.compression = compression;
    auto writer = Writer::open(file_, options);
    EXPECT_TRUE(writer.ok());
    return std::move(writer).value();
  }
  /// Two channels, a message of each every 100 ms, texts that compress well.
  void write_sample(Writer& writer, int messages) const {
    const auto schema = writer.add(Schema{"a/msg/Text", "ros2msg", "string text"});
    const auto one = writer.add(Channel{schema, "/one", "cdr", {{"sender", "1"}}});
    const auto two = writer.add(Channel{0, "/two", "cdr", {}});
    writer.add(Metadata{"skein", {{"node", "7"}, {"empty", ""}}});
    for (int i = 0; i < messages; ++i) {
      const Bytes data = bytes_of("message " + std::to_string(i));
      const std::uint64_t time = 10 * kSecond + static_cast<std::uint64_t>(i) * kSecond / 10;
      writer.write({i % 2 == 0 ? one : two, 0, time, time - 1, data});
    }
  }
  [[nodiscard]] Bytes contents() const {
    std::ifstream file{file_, std::ios::binary};
    return bytes_of(std::string{std::istreambuf_iterator<char>{file}, {}});
  }

  std::filesystem::path folder_;
  std::filesystem::path file_;
};

std::vector<std::string> texts_of(Reader& reader) {
  std::vector<std::string> texts;
  reader.for_each([&](const Message& message) {
    texts.emplace_back(message.data.begin(), message.data.end());
    return true;
  });
  return texts;
}

TEST(Crc32, IsThatOfZip) {
  EXPECT_EQ(crc32(bytes_of("123456789")), 0xCBF43926U);
  const Bytes long_text(1000, 'x');
  const std::span all{long_text};
  EXPECT_EQ(crc32(all), crc32(all.subspan(333), crc32(all.first(333))));
  EXPECT_EQ(crc32({}), 0U);
}

TEST_F(McapTest, WhatIsWrittenReadsBack) {
  for (const Compression compression : {Compression::none, Compression::zstd}) {
    {
      Writer writer = open(compression);
      write_sample(writer, 95);
      EXPECT_TRUE(writer.close().ok());
    }
    auto reader = Reader::open(file_);
    ASSERT_TRUE(reader.ok()) << reader.error().message;
    EXPECT_TRUE(reader->is_complete());
    EXPECT_EQ(reader->profile(), "ros2");
    EXPECT_EQ(reader->library(), "test");
    ASSERT_EQ(reader->schemas().size(), 1U);
    EXPECT_EQ(reader->schemas().at(1).text, "string text");
    ASSERT_EQ(reader->channels().size(), 2U);
    EXPECT_EQ(reader->channels().at(1).metadata.at("sender"), "1");
    EXPECT_EQ(reader->channels().at(2).topic, "/two");
    ASSERT_EQ(reader->metadata().size(), 1U);
    EXPECT_EQ(reader->metadata()[0].entries.at("node"), "7");
    EXPECT_EQ(reader->chunks().size(), 10U);  // one a second
    std::size_t count = 0;
    reader->for_each([&](const Message& message) {
      EXPECT_EQ(message.channel, count % 2 + 1);
      EXPECT_EQ(message.sequence, count / 2);
      EXPECT_EQ(message.publish_time_ns + 1, message.log_time_ns);
      EXPECT_EQ(std::string(message.data.begin(), message.data.end()),
                "message " + std::to_string(count));
      ++count;
      return true;
    });
    EXPECT_EQ(count, 95U);
    EXPECT_EQ(reader->damaged(), 0U);
  }
}

TEST_F(McapTest, AFileWithoutItsEndIsLookedThrough) {
  Writer writer = open();
  write_sample(writer, 95);
  ASSERT_TRUE(writer.flush().ok());
  auto reader = Reader::open(file_);  // while the writer goes on
  ASSERT_TRUE(reader.ok());
  EXPECT_FALSE(reader->is_complete());
  EXPECT_EQ(texts_of(*reader).size(), 95U);
  EXPECT_EQ(reader->metadata().size(), 1U);
  EXPECT_EQ(reader->damaged(), 0U);
}

TEST_F(McapTest, AnyByteThatIsWrongCostsItsChunkAtMost) {
  {
    Writer writer = open();
    write_sample(writer, 95);
  }
  const Bytes good = contents();
  Random random{7};
  for (int i = 0; i < 400; ++i) {
    Bytes bad = good;
    const std::size_t at = kMagic.size() + random.index(bad.size() - kMagic.size());
    bad[at] = static_cast<std::uint8_t>(bad[at] ^ (1U + random.index(255)));
    auto reader = Reader::of_bytes(bad, "bad");
    ASSERT_TRUE(reader.ok());
    EXPECT_GE(texts_of(*reader).size(), 85U) << "byte " << at;
  }
}

TEST_F(McapTest, OtherFilesAreRefused) {
  std::ofstream{file_} << "time,x,y\n";
  const auto reader = Reader::open(file_);
  ASSERT_FALSE(reader.ok());
  EXPECT_THAT(reader.error().message, HasSubstr("a.mcap is no MCAP file"));
  EXPECT_THAT(Reader::open(folder_ / "none.mcap").error().message, HasSubstr("none.mcap: No such"));
  EXPECT_FALSE(Reader::of_bytes({}, "empty").ok());
}

TEST_F(McapTest, ADiskErrorIsToldAndKept) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  auto writer = Writer::open("/dev/full", {});
  ASSERT_TRUE(writer.ok());
  const auto flushed = writer->flush();
  ASSERT_FALSE(flushed.ok());
  EXPECT_THAT(flushed.error().message, HasSubstr("/dev/full: No space left"));
  EXPECT_FALSE(writer->close().ok());
}

TEST_F(McapTest, ACursorGoesThroughSeveralFilesByTime) {
  const auto write = [&](const std::string& name, const std::vector<int>& times_s) {
    auto writer = Writer::open(folder_ / name, {});
    ASSERT_TRUE(writer.ok());
    const auto channel = writer->add(Channel{0, "/" + name, "", {}});
    for (const int time : times_s) {
      const Bytes data = bytes_of(name + std::to_string(time));
      writer->write({channel, 0, static_cast<std::uint64_t>(time) * kSecond, 0, data});
    }
  };
  write("a", {3, 1, 4, 9});
  write("b", {2, 4, 8});
  auto a = Reader::open(folder_ / "a");
  auto b = Reader::open(folder_ / "b");
  ASSERT_TRUE(a.ok() && b.ok());
  Cursor cursor{{&*a, &*b}};
  const auto rest = [&cursor] {
    std::vector<std::string> texts;
    while (const auto item = cursor.next()) {
      texts.emplace_back(item->message.data.begin(), item->message.data.end());
    }
    return texts;
  };
  EXPECT_THAT(rest(), ElementsAre("a1", "b2", "a3", "a4", "b4", "b8", "a9"));
  cursor.seek(4 * kSecond);
  EXPECT_THAT(rest(), ElementsAre("a4", "b4", "b8", "a9"));
  cursor.seek(4 * kSecond + 1);
  EXPECT_THAT(rest(), ElementsAre("b8", "a9"));
  cursor.seek(10 * kSecond);
  EXPECT_THAT(rest(), IsEmpty());
  cursor.seek(0);
  EXPECT_EQ(rest().size(), 7U);
  Cursor only{{&*a, &*b}, [](std::size_t file, std::uint16_t) { return file == 1; }};
  EXPECT_EQ(only.next()->file, 1U);
}

}  // namespace
}  // namespace skein::mcap
