// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/radio/mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

#include "skein/base/random.hpp"

namespace skein::hil::radio {
namespace {

using namespace std::chrono_literals;

const RadioParams kRadio{.range_m = 1500.0, .ground_range_m = 2000.0};

/// Vehicles 1 to n, 1,000 m apart to the east; the first is that far from the ground station.
std::vector<Node> chain(std::uint16_t vehicles) {
  std::vector<Node> nodes{{kGroundStation, std::nullopt}};
  for (std::uint16_t i = 1; i <= vehicles; ++i)
    nodes.push_back({VehicleId{i}, Vec2{1000.0 * i, 0}});
  return nodes;
}

TEST(Mesh, ReachesOverHops) {
  const Interference none;
  const auto nodes = chain(9);
  Mesh mesh{{.hops_max = 6}};
  mesh.move(kRadio, none, nodes, Instant{});
  EXPECT_EQ(mesh.hops(1, 2), 1);
  EXPECT_EQ(mesh.hops(1, 4), 3);
  EXPECT_EQ(mesh.hops(4, 9), 5);
  EXPECT_EQ(mesh.hops(2, 8), 6);
  EXPECT_EQ(mesh.hops(2, 9), 0) << "too many";
}

TEST(Mesh, ABrokenRouteIsMendedAfterAWhile) {
  const Interference none;
  // Two ways from 1 to 4: over 2, or over 3.
  std::vector<Node> nodes{{VehicleId{1}, Vec2{0, 0}},
                          {VehicleId{2}, Vec2{1000, 500}},
                          {VehicleId{3}, Vec2{1000, -500}},
                          {VehicleId{4}, Vec2{2000, 0}}};
  Mesh mesh{{.mend = 2s}};
  mesh.move(kRadio, none, nodes, Instant{});
  EXPECT_EQ(mesh.hops(0, 3), 2);
  nodes[1].position = Vec2{1000, 9000};
  mesh.move(kRadio, none, nodes, at_seconds(1.0));
  EXPECT_EQ(mesh.hops(0, 3), 0);
  EXPECT_EQ(mesh.hops(0, 2), 1);
  mesh.move(kRadio, none, nodes, at_seconds(2.0));
  EXPECT_EQ(mesh.hops(0, 3), 2);
  nodes[2].on = false;
  mesh.move(kRadio, none, nodes, at_seconds(3.0));
  EXPECT_EQ(mesh.hops(0, 3), 0);
}

TEST(Mesh, TheGroundStationNeedNotPassOn) {
  const Interference none;
  const std::vector<Node> nodes{{kGroundStation, std::nullopt},
                                {VehicleId{1}, Vec2{-1500, 0}},
                                {VehicleId{2}, Vec2{1500, 0}}};
  Mesh all{{}};
  all.move(kRadio, none, nodes, Instant{});
  EXPECT_EQ(all.hops(1, 2), 2);
  Mesh vehicles{{.ground_relays = false}};
  vehicles.move(kRadio, none, nodes, Instant{});
  EXPECT_EQ(vehicles.hops(1, 2), 0);
  EXPECT_EQ(vehicles.hops(1, 0), 1);
}

/// Against all pairs by Floyd and Warshall.
TEST(Mesh, IsAsShortAsCanBe) {
  const Interference none;
  Random random{4};
  for (int round = 0; round < 50; ++round) {
    std::vector<Node> nodes;
    for (std::uint16_t i = 1; i <= 24; ++i) {
      nodes.push_back({VehicleId{i}, Vec2{random.uniform(0, 8000), random.uniform(0, 7000)}});
    }
    Mesh mesh{{.hops_max = 30}};
    mesh.move(kRadio, none, nodes, Instant{});
    const std::size_t count = nodes.size();
    std::vector<std::vector<int>> hops(count, std::vector<int>(count, 1000));
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = 0; b < count; ++b) {
        if (a != b && is_up(kRadio, none, nodes[a], nodes[b])) hops[a][b] = 1;
      }
    }
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t a = 0; a < count; ++a) {
        for (std::size_t b = 0; b < count; ++b) {
          hops[a][b] = std::min(hops[a][b], hops[a][k] + hops[k][b]);
        }
      }
    }
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = 0; b < count; ++b) {
        EXPECT_TRUE(a == b || mesh.hops(a, b) == (hops[a][b] < 1000 ? hops[a][b] : 0));
      }
    }
  }
}

TEST(OverHops, EachHopLosesAndDelays) {
  const Link link{true, 0.1, 60ms, 30ms, std::nullopt};
  const Link way = over_hops(link, 3);
  EXPECT_TRUE(way.up);
  EXPECT_NEAR(way.loss, 1.0 - 0.9 * 0.9 * 0.9, 1e-12);
  EXPECT_EQ(way.delay, 180ms);
  EXPECT_EQ(way.jitter, 90ms);
  EXPECT_FALSE(over_hops(link, 0).up);
}

}  // namespace
}  // namespace skein::hil::radio
