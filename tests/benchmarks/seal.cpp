// SPDX-License-Identifier: Apache-2.0
//
// What sealing costs: an iteration is a datagram.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <vector>

#include "skein/seal/opener.hpp"
#include "skein/seal/sealer.hpp"

namespace skein::seal {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr EpochKey kKey{.epoch = 1};
constexpr SenderStart kStart{.sender = {3}, .number = 1, .random = 2};

Bytes message(benchmark::State& state) { return Bytes(static_cast<std::size_t>(state.range(0))); }

void seal_one(benchmark::State& state) {
  Sealer sealer{kStart, kKey};
  const Bytes plain = message(state);
  Bytes datagram;
  for (auto _ : state) benchmark::DoNotOptimize(sealer.seal(plain, datagram));
}
BENCHMARK(seal_one)->Name("seal/skein")->Arg(100)->Arg(500)->Arg(1400);

void open_one(benchmark::State& state) {
  constexpr std::size_t kBatch = 1000;
  Sealer sealer{kStart, kKey};
  Opener opener;
  opener.accept(kKey);
  std::vector<Bytes> datagrams(kBatch);
  Bytes plain = message(state);
  std::size_t next = kBatch;
  for (auto _ : state) {
    if (next == kBatch) {  // each can be opened once
      state.PauseTiming();
      plain = message(state);
      for (Bytes& datagram : datagrams) benchmark::DoNotOptimize(sealer.seal(plain, datagram));
      next = 0;
      state.ResumeTiming();
    }
    benchmark::DoNotOptimize(opener.open(datagrams[next++], plain, Instant{}));
  }
}
BENCHMARK(open_one)->Name("open/skein")->Arg(100)->Arg(500)->Arg(1400);

/// What a stranger can cost us: the start of a node that was never heard, for which a key is made.
void refuse_forged(benchmark::State& state) {
  Opener opener;
  opener.accept(kKey);
  Bytes plain;
  Bytes forged(kOverheadBytes + static_cast<std::size_t>(state.range(0)));
  const auto header = to_bytes({.epoch = 1, .from = kStart, .counter = 9});
  std::copy(header.begin(), header.end(), forged.begin());
  for (auto _ : state) benchmark::DoNotOptimize(opener.open(forged, plain, Instant{}));
}
BENCHMARK(refuse_forged)->Name("refuse_forged/skein")->Arg(100)->Arg(1400);

}  // namespace
}  // namespace skein::seal
