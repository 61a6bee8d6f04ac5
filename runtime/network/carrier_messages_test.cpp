// SPDX-License-Identifier: Apache-2.0
#include "carrier_messages.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace skein::network {
namespace {

using Bytes = std::vector<std::uint8_t>;

CarrierConfig config() {
  CarrierConfig config;
  config.domain = 9;
  config.self = VehicleId{3};
  config.instance = InstanceId{0x0102030405060708};
  config.run = 200;
  config.role = codec::Role::ground;
  config.endpoint = {"10.0.0.3", 7400};
  config.peers = {{VehicleId{1}, {"10.0.0.1", 7402}}, {VehicleId{2}, {"10.0.0.2", 7404}}};
  config.seal = CarrierConfig::Seal{.start = {VehicleId{3}, 5, 0xABCDEF},
                                    .key = {.epoch = 2},
                                    .counters = {1U << 20U, 1U << 21U}};
  config.seal->key.secret.fill(0x55);
  config.certificate = Bytes(identity::kCertificateBytesMax, 7);
  config.transport_plugin = "/usr/lib/skein/radio.so";
  return config;
}

std::vector<ToCarrier> all_to_carrier(const Bytes& sample) {
  CarrierConfig bare;
  return {config(),
          bare,
          WriteSample{codec::Topic::coalition, sample},
          Ping{7, std::uint64_t{1} << 40U},
          ChangeKey{{.epoch = 3}, std::chrono::seconds{3}},
          ForgetNews{},
          TellNews{{VehicleId{4}, 2, Bytes(100, 1)}, true}};
}

std::vector<FromCarrier> all_from_carrier(const Bytes& sample) {
  Pong pong{9, 77, {}};
  for (std::size_t i = 0; i < pong.counts.size(); ++i) pong.counts.at(i) = i * i;
  return {Joined{"memory is not limited"},
          Refused{"port in use"},
          Stuck{},
          HeardSample{codec::Topic::setup, VehicleId{5}, InstanceId{6}, sample},
          HeardCertificate{sample},
          HeardNews{sample},
          PeersNow{{{VehicleId{1}, InstanceId{2}, codec::Role::vehicle}, {}}},
          ReceptionsNow{{{VehicleId{1}, 100, 3, 70'000}, {}}},
          pong};
}

TEST(CarrierMessages, AreReadAsTheyWereWritten) {
  const Bytes sample{1, 2, 3, 4, 5};
  for (const ToCarrier& message : all_to_carrier(sample)) {
    const Bytes bytes = to_bytes(message);
    const auto read = to_carrier_from(bytes);
    ASSERT_TRUE(read) << message.index();
    EXPECT_EQ(read->index(), message.index());
    EXPECT_EQ(to_bytes(*read), bytes);
  }
  for (const FromCarrier& message : all_from_carrier(sample)) {
    const Bytes bytes = to_bytes(message);
    const auto read = from_carrier_from(bytes);
    ASSERT_TRUE(read) << message.index();
    EXPECT_EQ(read->index(), message.index());
    EXPECT_EQ(to_bytes(*read), bytes);
  }
}

TEST(CarrierMessages, AConfigurationComesWhole) {
  const Bytes bytes = to_bytes(ToCarrier{config()});
  const auto read = to_carrier_from(bytes);
  ASSERT_TRUE(read);
  const auto& got = std::get<CarrierConfig>(*read);
  EXPECT_EQ(got.run, 200);
  EXPECT_EQ(got.endpoint.address, "10.0.0.3");
  ASSERT_EQ(got.peers.size(), 2U);
  EXPECT_EQ(got.peers[1].endpoint.port, 7404);
  ASSERT_TRUE(got.seal);
  EXPECT_EQ(got.seal->start, config().seal->start);
  EXPECT_EQ(got.seal->key.secret, config().seal->key.secret);
  EXPECT_EQ(got.seal->counters.end, std::uint64_t{1} << 21U);
  EXPECT_EQ(got.certificate, config().certificate);
  EXPECT_EQ(got.transport_plugin, config().transport_plugin);
}

TEST(CarrierMessages, WhatIsCutOrLongerIsNone) {
  const Bytes sample;  // what carries bytes to its end may be shorter
  for (const ToCarrier& message : all_to_carrier(sample)) {
    Bytes bytes = to_bytes(message);
    const bool open_ended = std::holds_alternative<WriteSample>(message);
    bytes.push_back(0);
    EXPECT_EQ(to_carrier_from(bytes).has_value(), open_ended) << message.index();
    bytes.pop_back();
    while (!bytes.empty()) {
      bytes.pop_back();
      EXPECT_FALSE(to_carrier_from(bytes)) << message.index() << " of " << bytes.size();
    }
  }
  for (const FromCarrier& message : all_from_carrier(sample)) {
    Bytes bytes = to_bytes(message);
    while (!bytes.empty()) {
      bytes.pop_back();
      EXPECT_FALSE(from_carrier_from(bytes)) << message.index() << " of " << bytes.size();
    }
  }
}

TEST(CarrierMessages, ValuesThatThereAreNotAreRefused) {
  EXPECT_FALSE(from_carrier_from(Bytes{200}));
  const auto kind_of = [](const FromCarrier& message) { return to_bytes(message)[0]; };
  Bytes heard = to_bytes(FromCarrier{HeardSample{codec::Topic::setup, {}, {}, {}}});
  heard[1] = static_cast<std::uint8_t>(codec::kTopicCount);
  EXPECT_FALSE(from_carrier_from(heard));
  Bytes peers = to_bytes(FromCarrier{PeersNow{{{}}}});
  peers.back() = 3;  // a role
  EXPECT_FALSE(from_carrier_from(peers));
  // More peers than there are bytes: no memory is taken for them.
  EXPECT_FALSE(from_carrier_from(Bytes{kind_of(PeersNow{}), 0xFF, 0x0F}));
  Bytes certificate(1 + kCarrierBlobMax + 1, 0);
  certificate[0] = kind_of(HeardCertificate{});
  EXPECT_FALSE(from_carrier_from(certificate));
  EXPECT_FALSE(from_carrier_from(Bytes(kCarrierMessageBytesMax + 1, kind_of(HeardSample{}))));
}

TEST(CarrierMessages, AllPeersThatThereMayBeFit) {
  CarrierConfig large = config();
  large.peers.assign(kCarrierPeersMax, {VehicleId{65'535}, {"255.255.255.255", 65'534}});
  large.transport_plugin.assign(kCarrierTextMax, 'x');
  EXPECT_TRUE(to_carrier_from(to_bytes(ToCarrier{large})));
  EXPECT_TRUE(
      from_carrier_from(to_bytes(FromCarrier{PeersNow{std::vector<Peer>(kCarrierPeersMax)}})));
  EXPECT_TRUE(from_carrier_from(
      to_bytes(FromCarrier{ReceptionsNow{std::vector<Reception>(kCarrierPeersMax)}})));
}

}  // namespace
}  // namespace skein::network
