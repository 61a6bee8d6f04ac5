// SPDX-License-Identifier: Apache-2.0
#include "in_stream.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "skein/air/link.hpp"

namespace skein::air {
namespace {

constexpr std::uint64_t kEarlyMax = 512;  ///< parts ahead of the first missing one
constexpr Duration kAskAgain = std::chrono::milliseconds{60};
constexpr int kAskSlower = 2;  ///< so often the wait for an answer doubles

/// Others may be about to ask for the same.
Duration spread(Duration wait, Random& random) {
  return from_seconds(to_seconds(wait) * random.uniform(1.0, 2.0));
}

}  // namespace

std::uint64_t InStream::extended(std::uint16_t number) const {
  const auto ahead = static_cast<std::int16_t>(static_cast<std::uint16_t>(number - *next_));
  return *next_ + static_cast<std::uint64_t>(static_cast<std::int64_t>(ahead));
}

bool InStream::on_part(const PartFrame& part, const Deliver& deliver) {
  if (!next_) {
    if (!part.begins) return false;
    next_ = 0x10000U + part.number;
    newest_ = *next_ - 1;
  }
  const std::uint64_t number = extended(part.number);
  if (number < *next_ || number - *next_ > kEarlyMax) return false;
  newest_ = std::max(newest_, number);
  const bool is_new =
      early_
          .try_emplace(
              number,
              Held{part.channel, part.begins, part.ends, {part.bytes.begin(), part.bytes.end()}})
          .second;
  take_ready(deliver);
  return is_new;
}

void InStream::take_ready(const Deliver& deliver) {
  while (!early_.empty() && early_.begin()->first == *next_) {
    take(early_.begin()->second, deliver);
    early_.erase(early_.begin());
    ++*next_;
    asked_ = 0;
  }
  if (*next_ > newest_) ask_at_.reset();
}

void InStream::take(const Held& part, const Deliver& deliver) {
  if (part.begins) {
    joined_ = part;
  } else if (joined_ && joined_->channel == part.channel &&
             joined_->bytes.size() + part.bytes.size() <= Link::kSampleMax) {
    joined_->bytes.insert(joined_->bytes.end(), part.bytes.begin(), part.bytes.end());
  } else {
    joined_.reset();
  }
  if (!joined_ || !part.ends) return;
  deliver(joined_->channel, joined_->bytes);
  joined_.reset();
}

void InStream::skip_to(std::uint64_t number, const Deliver& deliver) {
  joined_.reset();
  while (*next_ < number) {
    const auto held = early_.find(*next_);
    if (held == early_.end()) {
      ++lost_;
      joined_.reset();
    } else {
      take(held->second, deliver);
      early_.erase(held);
    }
    ++*next_;
  }
  take_ready(deliver);
}

void InStream::on_head(const Head& head, Instant now, Random& random, const Deliver& deliver) {
  if (!next_) {
    next_ = 0x10000U + head.newest + 1U;
    newest_ = *next_ - 1;
  }
  const std::uint64_t newest = extended(head.newest);
  if (newest + 1 < *next_ || newest < newest_) return;  // overtaken by a later one
  newest_ = newest;
  const std::uint64_t oldest = newest + 1 - head.held;
  if (oldest > *next_) skip_to(oldest, deliver);
  if (*next_ > newest_ || ask_at_) return;
  ask_at_ = now + spread(patience_, random);
}

void InStream::on_newest(std::uint16_t newest, Instant now, Random& random) {
  if (!next_) return;
  const std::uint64_t number = extended(newest);
  if (number <= newest_ || number - *next_ > kEarlyMax) return;
  newest_ = number;
  if (!ask_at_) ask_at_ = now + spread(patience_, random);
}

void InStream::on_asked(const MissingFrame& missing, Instant now, Random& random) {
  if (!ask_at_ || extended(missing.first) > *next_) return;
  ask_at_ = std::max(*ask_at_, now + spread(kAskAgain, random));
}

std::optional<MissingFrame> InStream::ask(const Author& author, Instant now, Random& random) {
  if (*next_ > newest_) return std::nullopt;
  MissingFrame missing{author, static_cast<std::uint16_t>(*next_), 0};
  for (std::uint32_t i = 0; i < 32 && *next_ + 1 + i <= newest_; ++i) {
    if (!early_.contains(*next_ + 1 + i)) missing.more |= 1U << i;
  }
  ask_at_ = now + spread(kAskAgain * (1U << std::min(asked_++, kAskSlower)), random);
  return missing;
}

}  // namespace skein::air
