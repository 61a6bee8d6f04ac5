// SPDX-License-Identifier: Apache-2.0
//
// What it costs to say who one is: an iteration is a message, or a member.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <vector>

#include "skein/identity/certificate.hpp"
#include "skein/identity/key_change.hpp"
#include "skein/identity/node_key.hpp"
#include "skein/identity/signing.hpp"

namespace skein::identity {
namespace {

/// An authority and a member of its mission.
struct Mission {
  Mission() {
    const NodeKey authoritys = make_node_key(VehicleId{1});
    key = authoritys.sign;
    authority.role = Role::authority;
    authority.name = "bench";
    authority.sign_key = authoritys.sign_key();
    authority.not_after_unix_s = 2;
    sign(authority, key);
    own.serial.value = 1;
    own.node = node.node;
    own.sign_key = node.sign_key();
    own.agree_key = node.agree_key();
    own.not_after_unix_s = 2;
    sign(own, key);
  }
  Secret key;
  NodeKey node = make_node_key(VehicleId{7});
  Certificate authority;
  Certificate own;
};

Statement statement(const Bytes& body) {
  return {.topic = "coalition",
          .sender = VehicleId{7},
          .instance = InstanceId{1},
          .sequence = 1,
          .time = {},
          .body = body};
}

void sign_one(benchmark::State& state) {
  const Mission mission;
  const Signer signer{mission.own.mission, mission.node.sign};
  const Bytes body(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(signer.sign(statement(body)));
}
BENCHMARK(sign_one)->Name("sign/skein")->Arg(100)->Arg(1400);

void verify_one(benchmark::State& state) {
  const Mission mission;
  Verifier verifier{mission.authority};
  if (verifier.learn(mission.own, 1) != Trust::good) return state.SkipWithError("not learnt");
  const Bytes body(static_cast<std::size_t>(state.range(0)));
  const auto signature = Signer{mission.own.mission, mission.node.sign}.sign(statement(body));
  for (auto _ : state) benchmark::DoNotOptimize(verifier.verify(statement(body), signature));
}
BENCHMARK(verify_one)->Name("verify/skein")->Arg(100)->Arg(1400);

void grant_one(benchmark::State& state) {
  const Mission mission;
  for (auto _ : state) {
    benchmark::DoNotOptimize(make_grant({.epoch = 1}, mission.own, mission.key));
  }
}
BENCHMARK(grant_one)->Name("grant/skein");

void open_one_grant(benchmark::State& state) {
  const Mission mission;
  const EpochGrant grant = make_grant({.epoch = 1}, mission.own, mission.key);
  for (auto _ : state) {
    benchmark::DoNotOptimize(check(grant, mission.authority));
    benchmark::DoNotOptimize(open_grant(grant, mission.node.agree));
  }
}
BENCHMARK(open_one_grant)->Name("open_grant/skein");

}  // namespace
}  // namespace skein::identity
