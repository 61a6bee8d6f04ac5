// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/random.hpp"
#include "skein/seal/header.hpp"
#include "skein/seal/opener.hpp"
#include "skein/seal/sealer.hpp"

namespace skein::seal {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes bytes(std::string_view text) { return {text.begin(), text.end()}; }

EpochKey key(std::uint8_t epoch, std::uint8_t fill = 7) {
  EpochKey k{.epoch = epoch};
  k.secret.fill(fill);
  return k;
}

SenderStart start(std::uint16_t vehicle, std::uint16_t number = 1, std::uint32_t random = 99) {
  return {.sender = VehicleId{vehicle}, .number = number, .random = random};
}

Bytes sealed(Sealer& sealer, std::string_view text) {
  Bytes out;
  EXPECT_TRUE(sealer.seal(bytes(text), out));
  return out;
}

struct Opening : testing::Test {
  Opened open(const Bytes& datagram, Instant now = Instant{}) {
    return opener.open(datagram, plain, now).opened;
  }
  Opener opener;
  Bytes plain;
};

TEST(SealHeader, IsReadAsItWasWritten) {
  const Header header{
      .epoch = 200, .from = start(0xABCD, 0x1234, 0xFEDCBA), .counter = kCounterMax - 5};
  Bytes datagram(kOverheadBytes);
  const auto clear = to_bytes(header);
  std::copy(clear.begin(), clear.end(), datagram.begin());
  EXPECT_EQ(read_header(datagram), header);
  datagram.pop_back();
  EXPECT_FALSE(read_header(datagram));
}

TEST_F(Opening, GivesWhatWasSealedAndWhoSealedIt) {
  Sealer sealer{start(3), key(1)};
  opener.accept(key(1));
  for (const std::string_view text : {"", "a", "RTPS and more"}) {
    const Bytes datagram = sealed(sealer, text);
    EXPECT_EQ(datagram.size(), text.size() + 30);
    const auto outcome = opener.open(datagram, plain, Instant{});
    EXPECT_EQ(outcome.opened, Opened::good);
    EXPECT_EQ(outcome.from, start(3));
    EXPECT_EQ(plain, bytes(text));
  }
}

// The same as another implementation makes it: Python's cryptography 48, HKDF(SHA256, length 16,
// salt = a1 05 00 02 00 09 01 02 03 00 00 00 00 00, info = "skein datagram 1") of 32 bytes 0x07,
// AESGCM with the nonce 00 ... 00 and the header as what is authenticated only.
TEST_F(Opening, TheFormatIsFixed) {
  Sealer sealer{start(2, 9, 0x010203), key(5)};
  std::string hex;
  for (const std::uint8_t b : sealed(sealer, "telemetry")) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    hex += kDigits[b >> 4U];
    hex += kDigits[b & 15U];
  }
  EXPECT_EQ(hex, "a10500020009010203000000000095a9467489871d8806251cc416bf5cfd604f14e823a37e3a85");
}

TEST_F(Opening, NothingThatWasChangedIsGood) {
  Sealer sealer{start(3), key(1)};
  opener.accept(key(1));
  const Bytes datagram = sealed(sealer, "RTPS message");
  for (std::size_t bit = 0; bit < datagram.size() * 8; ++bit) {
    Bytes changed = datagram;
    changed[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    ASSERT_NE(open(changed), Opened::good) << "bit " << bit;
  }
  for (std::size_t size = 0; size < datagram.size(); ++size) {
    ASSERT_NE(open(Bytes(datagram.begin(), datagram.begin() + static_cast<std::ptrdiff_t>(size))),
              Opened::good);
  }
  EXPECT_EQ(open(datagram), Opened::good);  // none of them moved the window
}

TEST_F(Opening, ADatagramIsGoodOnceInAnyOrder) {
  Sealer sealer{start(3), key(1)};
  opener.accept(key(1));
  const Bytes first = sealed(sealer, "1");
  const Bytes second = sealed(sealer, "2");
  EXPECT_FALSE(opener.has_opened(read_header(second).value()));
  EXPECT_EQ(open(second), Opened::good);
  EXPECT_TRUE(opener.has_opened(read_header(second).value()));
  EXPECT_FALSE(opener.has_opened(read_header(first).value()));
  EXPECT_EQ(open(first), Opened::good);
  EXPECT_EQ(open(first), Opened::replayed);
  EXPECT_EQ(open(second), Opened::replayed);
}

TEST_F(Opening, SealersOfOneStartShareItsCounters) {
  opener.accept(key(1));
  Sealer first{start(3), key(1), {0, 2}};
  EXPECT_EQ(open(sealed(first, "0")), Opened::good);
  EXPECT_EQ(open(sealed(first, "1")), Opened::good);
  Bytes none;
  EXPECT_FALSE(first.seal(bytes("its counters are used up"), none));
  first.extend(3);
  first.extend(1);  // takes nothing back
  EXPECT_EQ(open(sealed(first, "2")), Opened::good);
  EXPECT_FALSE(first.seal(bytes("again"), none));
  EXPECT_EQ(first.next(), 3U);
  Sealer second{start(3), key(1), {3, 4}};
  EXPECT_EQ(open(sealed(second, "3")), Opened::good)
      << "of the same start, and none was seen before";
  Sealer last{start(3), key(1), {kCounterMax, ~std::uint64_t{0}}};
  EXPECT_EQ(open(sealed(last, "the last")), Opened::good);
  last.extend(~std::uint64_t{0});
  EXPECT_FALSE(last.seal(bytes("beyond"), none));
}

TEST_F(Opening, AnotherTeamsAreForged) {
  Sealer sealer{start(3), key(1, 8)};
  opener.accept(key(1, 7));
  EXPECT_EQ(open(sealed(sealer, "x")), Opened::forged);
  EXPECT_EQ(open(bytes("RTPS that nobody has sealed, of thirty bytes and more")),
            Opened::not_sealed);
}

TEST_F(Opening, AnEarlierStartIsNotHeardAgain) {
  Sealer before{start(3, 1), key(1)};
  Sealer after{start(3, 2), key(1)};
  opener.accept(key(1));
  const Bytes old = sealed(before, "old");
  EXPECT_EQ(open(sealed(before, "at its time")), Opened::good);
  EXPECT_EQ(open(sealed(after, "new")), Opened::good);
  EXPECT_EQ(open(old), Opened::old_start);
  EXPECT_EQ(open(sealed(after, "on")), Opened::good);
}

// Who had only the old key may have claimed the last start of all.
TEST_F(Opening, UnderANewerKeyStartsAreBelievedAnew) {
  opener.accept(key(1, 1));
  opener.accept(key(2, 2));
  Sealer node{start(3, 5), key(1, 1)};
  EXPECT_EQ(open(sealed(node, "a")), Opened::good);
  Sealer captor{start(3, 0xFFFF, 1), key(1, 1)};
  const Bytes claim = sealed(captor, "I am newer");
  EXPECT_EQ(open(claim), Opened::good);
  const Bytes late = sealed(node, "late");
  EXPECT_EQ(open(late), Opened::old_start);
  node.change(key(2, 2));
  const Bytes again = sealed(node, "b");
  EXPECT_EQ(open(again), Opened::good);
  EXPECT_EQ(open(again), Opened::replayed);
  EXPECT_EQ(open(claim), Opened::old_start);
  EXPECT_EQ(open(sealed(captor, "still")), Opened::old_start);
  EXPECT_EQ(open(late), Opened::good) << "its own, of just before";
  Sealer anew{start(3, 6, 2), key(2, 2)};
  EXPECT_EQ(open(sealed(anew, "c")), Opened::good);
}

// Two programs with one id: each is heard, and neither makes a replay of the other good.
TEST_F(Opening, TwinsDoNotHideEachOther) {
  opener.accept(key(1));
  Bytes first;
  for (std::uint32_t random = 0; random < Opener::kTwinsMax; ++random) {
    Sealer twin{start(3, 1, random), key(1)};
    const Bytes datagram = sealed(twin, "x");
    if (first.empty()) first = datagram;
    EXPECT_EQ(open(datagram), Opened::good);
  }
  EXPECT_EQ(open(first), Opened::replayed);
  Sealer more{start(3, 1, 77), key(1)};
  EXPECT_EQ(open(sealed(more, "x")), Opened::no_room);
}

TEST_F(Opening, AnOldKeyOpensForItsTime) {
  Sealer sealer{start(3), key(1, 1)};
  opener.accept(key(1, 1), at_seconds(10));
  opener.accept(key(2, 2));
  const Bytes late = sealed(sealer, "late");
  EXPECT_EQ(open(sealed(sealer, "a"), at_seconds(10)), Opened::good);
  sealer.change(key(2, 2));
  const Bytes with_new = sealed(sealer, "b");
  EXPECT_EQ(open(with_new, at_seconds(11)), Opened::good);
  EXPECT_EQ(open(with_new, at_seconds(11)), Opened::replayed);
  EXPECT_EQ(open(late, at_seconds(11)), Opened::unknown_epoch);
}

TEST_F(Opening, AKeyThatIsReplacedOpensNothing) {
  Sealer sealer{start(3), key(1, 1)};
  opener.accept(key(1, 1));
  EXPECT_EQ(open(sealed(sealer, "a")), Opened::good);
  opener.accept(key(1, 2));
  EXPECT_EQ(open(sealed(sealer, "b")), Opened::forged);
}

TEST_F(Opening, MemoryIsBounded) {
  opener.accept(key(1));
  Bytes datagram;
  for (std::uint16_t id = 0; id < Opener::kNodesMax; ++id) {
    Sealer sealer{start(id), key(1)};
    ASSERT_EQ(open(sealed(sealer, "x")), Opened::good);
  }
  Sealer more{start(Opener::kNodesMax), key(1)};
  EXPECT_EQ(open(sealed(more, "x")), Opened::no_room);
  EXPECT_EQ(opener.counts().at(static_cast<std::size_t>(Opened::no_room)), 1U);
}

// Forged, mutated, spliced, replayed: of a million none is good that was not meant.
TEST_F(Opening, AMillionHostileDatagrams) {
  constexpr int kDatagrams = 1'000'000;
  opener.accept(key(1));
  Random random{17};
  std::vector<Bytes> recorded;
  for (std::uint16_t id = 1; id <= 8; ++id) {
    Sealer sealer{start(id), key(1)};
    for (int i = 0; i < 32; ++i) {
      recorded.push_back(sealed(sealer, std::string(1 + random.index(300), 'x')));
      ASSERT_EQ(open(recorded.back()), Opened::good);
    }
  }
  int good = 0;
  for (int i = 0; i < kDatagrams; ++i) {
    Bytes hostile = recorded[random.index(recorded.size())];
    const Bytes& other = recorded[random.index(recorded.size())];
    switch (random.index(4)) {
      case 0:  // replayed as it is
        break;
      case 1:  // mutated
        for (std::uint64_t n = 1 + random.index(4); n > 0; --n) {
          hostile[random.index(hostile.size())] ^= static_cast<std::uint8_t>(1 + random.index(255));
        }
        break;
      case 2: {  // head of one, tail of another
        const auto cut = static_cast<std::ptrdiff_t>(random.index(hostile.size()));
        hostile.resize(static_cast<std::size_t>(cut));
        hostile.insert(hostile.end(),
                       other.begin() + std::min<std::ptrdiff_t>(cut, std::ssize(other)),
                       other.end());
        break;
      }
      default:  // a header that fits, and noise
        for (std::size_t at = kHeaderBytes; at < hostile.size(); ++at) {
          hostile[at] = static_cast<std::uint8_t>(random.index(256));
        }
        hostile[kHeaderBytes - 2] = 0xFF;  // a counter that was not used
    }
    if (open(hostile) == Opened::good) ++good;
  }
  EXPECT_EQ(good, 0);
}

}  // namespace
}  // namespace skein::seal
