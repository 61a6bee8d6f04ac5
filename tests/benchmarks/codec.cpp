// SPDX-License-Identifier: Apache-2.0
//
// What it costs to encode and to decode: an iteration is a message of every kind.
#include "skein/codec/codec.hpp"

#include <benchmark/benchmark.h>

#include <cstdint>
#include <vector>

#include "skein/random_messages/random_messages.hpp"

namespace skein::codec {
namespace {

std::vector<mission::Message> messages() {
  Random random{1};
  std::vector<mission::Message> all;
  for (std::size_t kind = 0; kind < 20 * kMessageKinds; ++kind) {
    all.push_back(random_message(kind % kMessageKinds, random));
  }
  return all;
}

void encode_all(benchmark::State& state) {
  const auto all = messages();
  std::size_t bytes = 0;
  for (auto _ : state) {
    for (const auto& message : all) {
      const auto encoded = encode(message);
      bytes += encoded->size();
      benchmark::DoNotOptimize(encoded->data());
    }
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(bytes));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(all.size()));
}
BENCHMARK(encode_all)->Name("encode/skein");

void decode_all(benchmark::State& state) {
  const auto all = messages();
  std::vector<std::pair<Topic, std::vector<std::uint8_t>>> samples;
  for (const auto& message : all) samples.emplace_back(topic_of(message), encode(message).value());
  std::size_t bytes = 0;
  for (auto _ : state) {
    for (const auto& [topic, sample] : samples) {
      const auto decoded = decode(topic, sample);
      bytes += sample.size();
      benchmark::DoNotOptimize(decoded.index());
    }
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(bytes));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(all.size()));
}
BENCHMARK(decode_all)->Name("decode/skein");

}  // namespace
}  // namespace skein::codec
