// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "skein/identity/authority.hpp"
#include "skein/identity/identity.hpp"

namespace skein::identity {

inline constexpr std::int64_t kNow_unix_s = 1'777'000'000;
inline constexpr std::int64_t kDay_s = 86'400;

/// An empty folder for each test, and a mission in it where one is asked for.
class TestMission : public testing::Test {
 public:
  TestMission(const TestMission&) = delete;
  TestMission& operator=(const TestMission&) = delete;
  ~TestMission() override { std::filesystem::remove_all(folder_); }

 protected:
  TestMission() {
    std::string name = testing::TempDir() + "skein-identity-XXXXXX";
    EXPECT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
  }

  [[nodiscard]] std::filesystem::path ground() const { return folder_ / "ground"; }
  [[nodiscard]] KeyFolder vehicle(std::uint16_t id) const {
    return {folder_ / ("vehicle-" + std::to_string(id)), {}};
  }
  [[nodiscard]] Authority create(int days = 30) const {
    auto made = Authority::create(ground(), "ridge", days, kNow_unix_s, Durable::no);
    EXPECT_TRUE(made) << made.error().message;
    return std::move(made).value();
  }
  [[nodiscard]] Request request(std::uint16_t id) const {
    const auto key = read_or_make_node_key(vehicle(id), VehicleId{id});
    EXPECT_TRUE(key) << key.error().message;
    return request_of(*key);
  }
  /// Enrolled, and its answer kept.
  Membership enrol(Authority& authority, std::uint16_t id) const {
    const std::vector requests{request(id)};
    const auto answers = authority.enrol(requests, kNow_unix_s);
    EXPECT_TRUE(answers) << answers.error().message;
    const auto kept = store_membership(vehicle(id), answers->front(), kNow_unix_s, false);
    EXPECT_TRUE(kept) << kept.error().message;
    return answers->front();
  }
  [[nodiscard]] Identity open(std::uint16_t id) const {
    auto opened = Identity::open(vehicle(id), kNow_unix_s);
    EXPECT_TRUE(opened) << opened.error().message;
    return std::move(opened).value();
  }
  static std::string text_in(const std::filesystem::path& file) {
    std::ifstream stream{file};
    return {std::istreambuf_iterator<char>{stream}, {}};
  }
  static void put(const std::filesystem::path& file, const std::string& text) {
    std::ofstream{file} << text;
  }

  std::filesystem::path folder_;
};

}  // namespace skein::identity
