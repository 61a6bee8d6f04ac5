// SPDX-License-Identifier: Apache-2.0
#include "frames.hpp"

#include <type_traits>

namespace skein::air {
namespace {

constexpr std::uint8_t kFormat = 0x51;
constexpr std::uint8_t kFar = 0x80;

/// Of a part 4: whole, 5: it begins, 6: it ends, 7: neither; the same of one that is said again. Of
/// a hearing 14: it goes on.
enum Kind : std::uint8_t {
  sample = 1,
  part = 4,
  hello = 8,
  certificate = 9,
  missing = 10,
  want = 11,
  passed_on = 12,
  hearing = 13,
  introduction = 15,
  newest = 16,
  passed_on_late = 17,
  part_again = 18
};

template <class Number>
void put(std::vector<std::uint8_t>& out, Number number) {
  for (std::size_t i = sizeof(Number); i-- > 0;) {
    out.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(number) >> (8 * i)));
  }
}

void put(std::vector<std::uint8_t>& out, const Author& author) {
  put(out, author.node.value);
  put(out, author.instance.value);
}

void put_bytes(std::vector<std::uint8_t>& out, std::span<const std::uint8_t> bytes) {
  put(out, static_cast<std::uint16_t>(bytes.size()));
  out.insert(out.end(), bytes.begin(), bytes.end());
}

/// Reads numbers until there is too little; then all is nothing.
class Cutter {
 public:
  explicit Cutter(std::span<const std::uint8_t>& rest) : rest_{rest} {}

  template <class Number>
  [[nodiscard]] Number number() {
    std::uint64_t value = 0;
    for (const std::uint8_t byte : bytes(sizeof(Number))) value = value << 8U | byte;
    return static_cast<Number>(value);
  }
  [[nodiscard]] Author author() {
    const VehicleId node{number<std::uint16_t>()};
    return {node, InstanceId{number<std::uint64_t>()}};
  }
  [[nodiscard]] std::span<const std::uint8_t> bytes(std::size_t count) {
    if (rest_.size() < count) {
      good_ = false;
      rest_ = {};
      return {};
    }
    const auto cut = rest_.first(count);
    rest_ = rest_.subspan(count);
    return cut;
  }
  [[nodiscard]] std::span<const std::uint8_t> counted_bytes() {
    return bytes(number<std::uint16_t>());
  }
  [[nodiscard]] bool good() const { return good_; }

 private:
  std::span<const std::uint8_t>& rest_;
  bool good_ = true;
};

PartFrame cut_part(Cutter& cut, std::uint8_t kind) {
  PartFrame frame;
  frame.again = kind >= part_again;
  const int form = kind - (frame.again ? part_again : part);
  frame.begins = form == 0 || form == 1;
  frame.ends = form == 0 || form == 2;
  frame.channel = cut.number<std::uint8_t>();
  frame.number = cut.number<std::uint16_t>();
  frame.bytes = cut.counted_bytes();
  return frame;
}

/// None where the kind is unknown; of no meaning where the bytes did not suffice.
std::optional<Frame> cut_frame(Cutter& cut) {
  const auto kind = cut.number<std::uint8_t>();
  switch (kind) {  // what is between braces is cut from left to right
    case sample:
      return SampleFrame{cut.number<std::uint8_t>(), cut.counted_bytes()};
    case part:
    case part + 1:
    case part + 2:
    case part + 3:
    case part_again:
    case part_again + 1:
    case part_again + 2:
    case part_again + 3:
      return cut_part(cut, kind);
    case hello:
      return HelloFrame{cut.number<std::uint8_t>(), cut.number<std::uint32_t>()};
    case certificate:
      return CertificateFrame{cut.counted_bytes()};
    case missing:
      return MissingFrame{cut.author(), cut.number<std::uint16_t>(), cut.number<std::uint32_t>()};
    case want:
      return WantFrame{cut.author()};
    case passed_on:
    case passed_on_late:
      return PassedOnFrame{kind != passed_on, cut.number<std::uint8_t>(), cut.counted_bytes()};
    case hearing:
    case hearing + 1:
      return HearingFrame{kind != hearing, VehicleId{cut.number<std::uint16_t>()},
                          cut.bytes(cut.number<std::uint8_t>())};
    case introduction:
      return IntroductionFrame{cut.author(), cut.number<std::uint8_t>(), cut.counted_bytes()};
    case newest:
      return NewestFrame{cut.author(), cut.number<std::uint16_t>()};
    default:
      return std::nullopt;
  }
}

std::uint8_t kind_of(const PartFrame& frame) {
  const int form = frame.begins ? (frame.ends ? 0 : 1) : (frame.ends ? 2 : 3);
  return static_cast<std::uint8_t>((frame.again ? part_again : part) + form);
}

}  // namespace

bool is_asked_for(const MissingFrame& missing, std::uint16_t part) {
  const auto after = static_cast<std::uint16_t>(part - missing.first);
  return after == 0 || (after <= kMoreMissing && (missing.more >> (after - 1U) & 1U) != 0);
}

std::optional<Head> read_head(std::span<const std::uint8_t>& rest) {
  Cutter cut{rest};
  const auto format = cut.number<std::uint8_t>();
  const bool ours = (format & ~unsigned{kFar}) == kFormat;
  Head head;
  head.far = (format & kFar) != 0;
  head.newest = cut.number<std::uint16_t>();
  head.held = cut.number<std::uint8_t>();
  return ours && cut.good() ? std::optional{head} : std::nullopt;
}

std::optional<Frame> read_frame(std::span<const std::uint8_t>& rest) {
  Cutter cut{rest};
  const auto frame = cut_frame(cut);
  return cut.good() ? frame : std::nullopt;
}

void write(std::vector<std::uint8_t>& out, const Head& head) {
  put(out, static_cast<std::uint8_t>(head.far ? kFormat | kFar : kFormat));
  put(out, head.newest);
  put(out, head.held);
}

void write(std::vector<std::uint8_t>& out, const Frame& any) {
  std::visit(
      [&out]<class T>(const T& frame) {
        if constexpr (std::is_same_v<T, SampleFrame>) {
          put(out, std::uint8_t{sample});
          put(out, frame.channel);
          put_bytes(out, frame.bytes);
        } else if constexpr (std::is_same_v<T, PartFrame>) {
          put(out, kind_of(frame));
          put(out, frame.channel);
          put(out, frame.number);
          put_bytes(out, frame.bytes);
        } else if constexpr (std::is_same_v<T, HelloFrame>) {
          put(out, std::uint8_t{hello});
          put(out, frame.role);
          put(out, frame.certificate);
        } else if constexpr (std::is_same_v<T, CertificateFrame>) {
          put(out, std::uint8_t{certificate});
          put_bytes(out, frame.bytes);
        } else if constexpr (std::is_same_v<T, MissingFrame>) {
          put(out, std::uint8_t{missing});
          put(out, frame.author);
          put(out, frame.first);
          put(out, frame.more);
        } else if constexpr (std::is_same_v<T, WantFrame>) {
          put(out, std::uint8_t{want});
          put(out, frame.author);
        } else if constexpr (std::is_same_v<T, PassedOnFrame>) {
          put(out, std::uint8_t{frame.late ? passed_on_late : passed_on});
          put(out, frame.hops);
          put_bytes(out, frame.bytes);
        } else if constexpr (std::is_same_v<T, HearingFrame>) {
          put(out, static_cast<std::uint8_t>(frame.goes_on ? hearing + 1 : hearing));
          put(out, frame.first.value);
          put(out, static_cast<std::uint8_t>(frame.bits.size()));
          out.insert(out.end(), frame.bits.begin(), frame.bits.end());
        } else if constexpr (std::is_same_v<T, IntroductionFrame>) {
          put(out, std::uint8_t{introduction});
          put(out, frame.author);
          put(out, frame.role);
          put_bytes(out, frame.certificate);
        } else {
          put(out, std::uint8_t{newest});
          put(out, frame.author);
          put(out, frame.newest);
        }
      },
      any);
}

std::size_t size_of(const Frame& any) {
  return std::visit(
      []<class T>(const T& frame) -> std::size_t {
        if constexpr (std::is_same_v<T, SampleFrame>) return 4 + frame.bytes.size();
        if constexpr (std::is_same_v<T, PartFrame>) return kPartBytes + frame.bytes.size();
        if constexpr (std::is_same_v<T, HelloFrame>) return 6;
        if constexpr (std::is_same_v<T, CertificateFrame>) return 3 + frame.bytes.size();
        if constexpr (std::is_same_v<T, MissingFrame>) return 17;
        if constexpr (std::is_same_v<T, PassedOnFrame>) return kPassedOnBytes + frame.bytes.size();
        if constexpr (std::is_same_v<T, HearingFrame>) return 4 + frame.bits.size();
        if constexpr (std::is_same_v<T, IntroductionFrame>) return 14 + frame.certificate.size();
        if constexpr (std::is_same_v<T, NewestFrame>) return 13;
        return 11;
      },
      any);
}

}  // namespace skein::air
