// SPDX-License-Identifier: Apache-2.0
#include "in_stream.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "skein/air/link.hpp"

namespace skein::air {
namespace {

constexpr std::uint64_t kEarlyMax = 512;  ///< parts ahead of the first missing one
/// What one other says that there is, is no more than a head can say.
constexpr std::uint64_t kHearsayMax = 255;
/// What is due so soon after another is asked for with it.
constexpr Duration kTogether = std::chrono::milliseconds{5};

/// Others may be about to ask for the same: by so much longer this one waits.
double spread(Random& random) { return random.uniform(1.0, 1.5); }

Duration longer(Duration wait, double by) { return from_seconds(to_seconds(wait) * by); }

}  // namespace

std::uint64_t InStream::extended(std::uint16_t number) const {
  const auto ahead = static_cast<std::int16_t>(static_cast<std::uint16_t>(number - *next_));
  return *next_ + static_cast<std::uint64_t>(static_cast<std::int64_t>(ahead));
}

/// What lies between what was known and this is missing from now on, and is asked for together.
void InStream::know_of(std::uint64_t newest, bool hearsay, Instant now, Random& random) {
  if (newest <= newest_) return;
  const Instant ask_at = now + pace_->patience(now, random);
  while (newest_ < newest) missing_.emplace(++newest_, Missing{now, ask_at, hearsay});
}

bool InStream::on_part(const PartFrame& part, bool late, Instant now, Random& random,
                       const Deliver& deliver) {
  if (!next_) {
    if (!part.begins) return false;
    next_ = 0x10000U + part.number;
    newest_ = *next_ - 1;
  }
  const std::uint64_t number = extended(part.number);
  if (number < *next_ || number - *next_ > kEarlyMax) return false;
  if (number > newest_) {
    know_of(number, false, now, random);
    missing_.erase(number);
  } else {
    const auto missing = missing_.find(number);
    if (missing == missing_.end()) return false;
    learn_from(missing->second, late || part.again, now);
    missing_.erase(missing);
  }
  early_.emplace(
      number, Held{part.channel, part.begins, part.ends, {part.bytes.begin(), part.bytes.end()}});
  take_ready(deliver);
  return true;
}

void InStream::learn_from(const Missing& missing, bool again, Instant now) {
  if (missing.hearsay) return;
  if (!again) {
    pace_->on_late(now - missing.since, now);
  } else if (missing.asked == 1 && !missing.others_asked) {
    pace_->on_answer(now - missing.asked_at);
  } else if (missing.asked > 1) {
    pace_->on_late_answer();
  }
}

void InStream::take_ready(const Deliver& deliver) {
  while (!early_.empty() && early_.begin()->first == *next_) {
    take(early_.begin()->second, deliver);
    early_.erase(early_.begin());
    ++*next_;
  }
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
  missing_.erase(missing_.begin(), missing_.lower_bound(number));
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
  newest_ = std::max(newest_, number - 1);
  take_ready(deliver);
}

void InStream::on_head(const Head& head, Instant now, Random& random, const Deliver& deliver) {
  if (!next_) {
    next_ = 0x10000U + head.newest + 1U;
    newest_ = *next_ - 1;
  }
  const std::uint64_t newest = extended(head.newest);
  if (newest + 1 < *next_ || (newest < newest_ && !forget_hearsay_after(newest))) {
    return;  // overtaken by a later one
  }
  const std::uint64_t oldest = newest + 1 - head.held;
  if (oldest > *next_) skip_to(oldest, deliver);
  know_of(newest, false, now, random);
}

/// Who passed on that there is more was wrong, or this comes late: then it is known of again.
bool InStream::forget_hearsay_after(std::uint64_t newest) {
  const auto from = missing_.upper_bound(newest);
  const auto is_said = [](const auto& entry) { return !entry.second.hearsay; };
  const auto known = early_.empty() ? 0 : early_.rbegin()->first;
  if (known > newest || std::any_of(from, missing_.end(), is_said)) return false;
  missing_.erase(from, missing_.end());
  newest_ = newest;
  return true;
}

void InStream::on_newest(std::uint16_t newest, Instant now, Random& random) {
  if (!next_) return;
  const std::uint64_t number = extended(newest);
  if (number > newest_ && number - newest_ <= kHearsayMax) know_of(number, true, now, random);
}

void InStream::on_asked(const MissingFrame& asked, Instant now, Random& random) {
  const Instant answered = now + longer(pace_->ask_again(0), spread(random));
  for (auto& [number, missing] : missing_) {
    if (!is_asked_for(asked, static_cast<std::uint16_t>(number))) continue;
    missing.others_asked = true;
    missing.ask_at = std::max(missing.ask_at, answered);
  }
}

std::optional<Instant> InStream::ask_at() const {
  std::optional<Instant> at;
  for (const auto& [number, missing] : missing_)
    at = std::min(at.value_or(missing.ask_at), missing.ask_at);
  return at;
}

std::optional<MissingFrame> InStream::ask(const Author& author, Instant now, Random& random) {
  std::optional<MissingFrame> question;
  std::uint64_t first = 0;
  const double later = spread(random);
  for (auto& [number, missing] : missing_) {
    if (missing.ask_at > now + kTogether) continue;
    if (!question) {
      first = number;
      question = MissingFrame{author, static_cast<std::uint16_t>(number), 0};
    } else if (number - first <= kMoreMissing) {
      question->more |= 1U << (number - first - 1);
    } else {
      break;
    }
    missing.asked_at = now;
    missing.ask_at = now + longer(pace_->ask_again(missing.asked++), later);
  }
  return question;
}

}  // namespace skein::air
