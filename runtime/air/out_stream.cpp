// SPDX-License-Identifier: Apache-2.0
#include "out_stream.hpp"

#include <chrono>
#include <utility>

namespace skein::air {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kHeldMax = 255;  ///< as the head can say
constexpr Duration kHeldFor = 15s;     ///< the longest gap after which nothing is lost

}  // namespace

PartFrame OutStream::add(std::uint8_t channel, bool begins, bool ends,
                         std::vector<std::uint8_t> bytes, Instant now) {
  if (parts_.size() == kHeldMax) {
    if (parts_.front().wanted) --wanted_;
    parts_.pop_front();
  }
  Part& part = parts_.emplace_back();
  part.bytes = std::move(bytes);
  part.frame = {channel, ++newest_, begins, ends, false, part.bytes};
  part.said_at = part.heard_of_at = now;
  return part.frame;
}

void OutStream::asked(const MissingFrame& missing, Duration answered, Instant now) {
  for (std::size_t i = 0; i <= kMoreMissing; ++i) {
    if (!is_asked_for(missing, static_cast<std::uint16_t>(missing.first + i))) continue;
    // How many parts it is behind the newest; one of the future is many.
    const auto behind = static_cast<std::uint16_t>(newest_ - missing.first - i);
    if (behind >= parts_.size()) continue;
    Part& part = parts_[parts_.size() - 1 - behind];
    if (part.wanted || now - part.heard_of_at < answered) continue;
    part.wanted = true;
    ++wanted_;
  }
}

std::optional<PartFrame> OutStream::wanted(std::size_t& from) const {
  for (; wanted_ > 0 && from < parts_.size(); ++from) {
    if (!parts_[from].wanted) continue;
    PartFrame frame = parts_[from].frame;
    frame.again = true;
    return frame;
  }
  return std::nullopt;
}

void OutStream::said_again(std::size_t at, Instant now) {
  parts_[at].wanted = false;
  parts_[at].heard_of_at = now;
  --wanted_;
}

void OutStream::forget(Instant now) {
  while (!parts_.empty() && now - parts_.front().said_at > kHeldFor) {
    if (parts_.front().wanted) --wanted_;
    parts_.pop_front();
  }
}

Head OutStream::head() const { return {newest_, static_cast<std::uint8_t>(parts_.size())}; }

}  // namespace skein::air
