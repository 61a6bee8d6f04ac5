// SPDX-License-Identifier: Apache-2.0
#include "skein/air/link.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <deque>
#include <map>
#include <utility>
#include <variant>

#include "frames.hpp"
#include "in_stream.hpp"
#include "out_stream.hpp"
#include "skein/base/assert.hpp"
#include "skein/base/random.hpp"

namespace skein::air {
namespace {

using namespace std::chrono_literals;

/// How long a sample may wait for others to share its datagram with, by urgency.
constexpr std::array<Duration, kUrgencies> kPatience{3ms, 20ms, 50ms, 100ms};
/// What must be left of a second's budget for it to be spent on them, by urgency, as a part.
constexpr std::array<double, kUrgencies> kReserve{0.0, 0.2, 0.4, 0.6};
constexpr double kBurst_s = 1.0;

constexpr double kHello_s = 1.0;
constexpr Duration kHelloEarly = 200ms;  ///< before it is due, where a datagram goes anyway
constexpr double kGreet_s = 0.05;        ///< who is new is greeted within twice that
constexpr Duration kGreetEvery = 200ms;
constexpr int kGreetings = 3;  ///< after somebody new was heard, for the case that one is lost
constexpr double kAgain_s = 0.3;
constexpr double kWant_s = 0.3;
constexpr Duration kForgetAfter = 60s;
/// A long sample is begun in what is left of a datagram only if that is worth it.
constexpr std::size_t kPieceMin = 200;

/// FNV-1a, by which one certificate is told from another: for those who do not lie about it.
std::uint32_t hash_of(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return 0;
  std::uint32_t hash = 2166136261U;
  for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 16777619U;
  return std::max<std::uint32_t>(hash, 1);
}

}  // namespace

class Link::Impl {
 public:
  Impl(LinkConfig config, LinkSink& sink, Instant now)
      : config_{std::move(config)},
        sink_{sink},
        random_{config_.seed},
        certificate_{hash_of(config_.certificate)},
        hello_at_{now + from_seconds(random_.uniform(0.0, kGreet_s))},
        greet_with_certificate_{certificate_ != 0},
        tokens_{kBurst_s * config_.bytes_per_s.value_or(0.0)},
        filled_at_{now} {}

  bool send(std::uint8_t channel, std::vector<std::uint8_t> bytes, Instant now);
  void hear(const Author& from, std::span<const std::uint8_t> datagram, Instant now);
  [[nodiscard]] Instant due() const;
  [[nodiscard]] std::optional<std::vector<std::uint8_t>> poll(Instant now);
  [[nodiscard]] std::vector<LinkPeer> peers(Instant now) const;
  [[nodiscard]] const LinkCounts& counts() const { return counts_; }

 private:
  struct Waiting {
    std::uint8_t channel = 0;
    std::vector<std::uint8_t> bytes;
    Instant since;
    std::size_t said = 0;  ///< of its bytes
  };
  struct Remote {
    InStream stream;
    Instant heard_at;
    std::optional<HelloFrame> hello;
    std::uint32_t certificate = 0;  ///< that was heard
    std::optional<Instant> want_at;
  };

  [[nodiscard]] InStream::Deliver deliver_from(const Author& author) {
    return [this, &author](std::uint8_t channel, std::span<const std::uint8_t> bytes) {
      if (channel < config_.channels.size()) sink_.on_sample(channel, author, bytes);
    };
  }
  Remote* remote_of(const Author& author, Instant now);
  void forget_silent(Instant now);
  void greet(Instant now);
  void on_frame(const Author& from, Remote& remote, const Frame& frame, Instant now);
  void on_hello(Remote& remote, const HelloFrame& hello, Instant now);
  void on_missing(const MissingFrame& missing, Instant now);

  [[nodiscard]] Instant when_affordable(Urgency urgency, Instant from) const;
  void refill(Instant now);

  [[nodiscard]] std::size_t room() const { return config_.datagram_bytes - out_.size(); }
  bool put(const Frame& frame);
  void put_greeting(Instant now);
  void put_questions(Instant now);
  void note_questions(const Remote& remote);
  void put_repairs(Instant now);
  void put_waiting(Urgency urgency, Instant now);
  bool put_part(Waiting& waiting, Instant now);

  const LinkConfig config_;
  LinkSink& sink_;
  Random random_;
  const std::uint32_t certificate_;

  std::array<std::deque<Waiting>, kUrgencies> waiting_;
  std::optional<Waiting> begun_;  ///< some parts of it were said; the others must follow
  OutStream stream_;
  Instant repairs_since_;
  std::map<Author, Remote> remotes_;
  std::optional<Instant> questions_at_;  ///< no question of any remote is due before

  Instant hello_at_;
  std::optional<Instant> greeted_at_;
  bool greet_with_certificate_;
  int greetings_ = kGreetings;  ///< that are to follow soon

  double tokens_;
  Instant filled_at_;
  std::vector<std::uint8_t> out_;  ///< the datagram that is being made
  LinkCounts counts_;
};

// --- what is to be said --------------------------------------------------------------------------

bool Link::Impl::send(std::uint8_t channel, std::vector<std::uint8_t> bytes, Instant now) {
  SKEIN_ASSERT(channel < config_.channels.size());
  if (bytes.size() > kSampleMax) return false;
  const Channel& as = config_.channels[channel];
  auto& queue = waiting_[static_cast<std::size_t>(as.urgency)];
  const auto of_channel = [channel](const Waiting& w) { return w.channel == channel; };
  if (static_cast<std::size_t>(std::ranges::count_if(queue, of_channel)) >= as.kept) {
    queue.erase(std::ranges::find_if(queue, of_channel));
    ++counts_.gave_way;
  }
  queue.push_back({channel, std::move(bytes), now});
  return true;
}

Instant Link::Impl::when_affordable(Urgency urgency, Instant from) const {
  if (!config_.bytes_per_s) return from;
  const double burst = kBurst_s * *config_.bytes_per_s;
  const double needed = kReserve[static_cast<std::size_t>(urgency)] * burst;
  if (tokens_ > needed) return from;
  return std::max(from, filled_at_ + from_seconds((needed - tokens_) / *config_.bytes_per_s) + 1ms);
}

void Link::Impl::refill(Instant now) {
  if (!config_.bytes_per_s) return;
  tokens_ = std::min(tokens_ + to_seconds(now - filled_at_) * *config_.bytes_per_s,
                     kBurst_s * *config_.bytes_per_s);
  filled_at_ = now;
}

Instant Link::Impl::due() const {
  Instant due = when_affordable(Urgency::state, hello_at_);
  const auto sooner = [&](Urgency urgency, Instant at) {
    due = std::min(due, when_affordable(urgency, at));
  };
  if (begun_) sooner(config_.channels[begun_->channel].urgency, begun_->since);
  if (stream_.wants()) sooner(Urgency::decision, repairs_since_ + kPatience.front());
  for (std::size_t u = 0; u < kUrgencies; ++u) {
    if (waiting_[u].empty()) continue;
    sooner(static_cast<Urgency>(u), waiting_[u].front().since + kPatience[u]);
  }
  if (questions_at_) sooner(Urgency::decision, *questions_at_);
  return due;
}

std::optional<std::vector<std::uint8_t>> Link::Impl::poll(Instant now) {
  if (now < due()) return std::nullopt;
  refill(now);
  stream_.forget(now);
  out_.clear();
  write(out_, Head{});  // what it says is known at the end
  put_greeting(now);
  if (begun_ && put_part(*begun_, now)) begun_.reset();
  if (questions_at_ && now >= *questions_at_) put_questions(now);
  if (!begun_) {
    put_repairs(now);
    for (std::size_t u = 0; u < kUrgencies; ++u) {
      const auto urgency = static_cast<Urgency>(u);
      if (when_affordable(urgency, now) > now) break;
      put_waiting(urgency, now);
    }
  }
  if (out_.size() == kHeadBytes) return std::nullopt;
  std::vector<std::uint8_t> head;
  write(head, stream_.head());
  std::ranges::copy(head, out_.begin());
  const std::size_t size = out_.size() + config_.overhead_bytes;
  tokens_ -= static_cast<double>(size);
  ++counts_.datagrams;
  counts_.bytes += size;
  return out_;
}

bool Link::Impl::put(const Frame& frame) {
  if (size_of(frame) > room()) return false;
  write(out_, frame);
  return true;
}

void Link::Impl::put_greeting(Instant now) {
  if (now < hello_at_ - kHelloEarly) return;
  (void)put(HelloFrame{config_.role, certificate_});
  if (greet_with_certificate_)
    greet_with_certificate_ = !put(CertificateFrame{config_.certificate});
  forget_silent(now);
  greeted_at_ = now;
  const double next_s = greetings_ > 0 ? kAgain_s : kHello_s;
  greetings_ = std::max(greetings_ - 1, 0);
  hello_at_ = now + from_seconds(next_s * random_.uniform(0.9, 1.1));
}

void Link::Impl::put_questions(Instant now) {
  questions_at_.reset();
  for (auto& [author, remote] : remotes_) {
    if (remote.want_at && now >= *remote.want_at && put(WantFrame{author})) {
      remote.want_at = now + from_seconds(random_.uniform(kWant_s, 4.0 * kWant_s));
    }
    const auto at = remote.stream.ask_at();
    if (at && now >= *at && room() >= size_of(MissingFrame{})) {
      const auto missing = remote.stream.ask(author, now, random_);
      if (missing) (void)put(*missing);
    }
    note_questions(remote);
  }
}

void Link::Impl::note_questions(const Remote& remote) {
  for (const auto& at : {remote.stream.ask_at(), remote.want_at}) {
    if (at) questions_at_ = std::min(questions_at_.value_or(*at), *at);
  }
}

void Link::Impl::put_repairs(Instant now) {
  std::size_t at = 0;
  for (auto part = stream_.wanted(at); part && put(*part); part = stream_.wanted(at)) {
    stream_.said_again(at, now);
    ++counts_.repairs;
  }
}

void Link::Impl::put_waiting(Urgency urgency, Instant now) {
  auto& queue = waiting_[static_cast<std::size_t>(urgency)];
  const std::size_t largest = config_.datagram_bytes - kHeadBytes - kPartBytes;
  for (auto waiting = queue.begin(); waiting != queue.end();) {
    const bool splits = waiting->bytes.size() > largest;
    if (config_.channels[waiting->channel].reliable || splits) {
      const std::size_t needed = kPartBytes + (splits ? kPieceMin : waiting->bytes.size());
      if (needed > room()) return;  // in its order
      if (!put_part(*waiting, now)) {
        begun_ = std::move(*waiting);
        queue.erase(waiting);
        return;
      }
    } else if (!put(SampleFrame{waiting->channel, waiting->bytes})) {
      ++waiting;
      continue;
    }
    waiting = queue.erase(waiting);
  }
}

/// As much of it as there is room for. Whether that was the last of it.
bool Link::Impl::put_part(Waiting& waiting, Instant now) {
  if (room() <= kPartBytes) return false;
  const std::size_t left = waiting.bytes.size() - waiting.said;
  const std::size_t size = std::min(left, room() - kPartBytes);
  const auto from = waiting.bytes.begin() + static_cast<std::ptrdiff_t>(waiting.said);
  const PartFrame part = stream_.add(waiting.channel, waiting.said == 0, size == left,
                                     {from, from + static_cast<std::ptrdiff_t>(size)}, now);
  (void)put(part);
  waiting.said += size;
  return size == left;
}

// --- what is heard -------------------------------------------------------------------------------

Link::Impl::Remote* Link::Impl::remote_of(const Author& author, Instant now) {
  const auto known = remotes_.find(author);
  if (known != remotes_.end()) return &known->second;
  if (remotes_.size() >= kAuthorsMax) {
    ++counts_.too_many;
    return nullptr;
  }
  greet_with_certificate_ = certificate_ != 0;
  greetings_ = kGreetings;
  greet(now);
  return &remotes_[author];
}

/// Somebody should hear of us soon.
void Link::Impl::greet(Instant now) {
  const Instant earliest = greeted_at_ ? std::max(now, *greeted_at_ + kGreetEvery) : now;
  hello_at_ =
      std::min(hello_at_, earliest + from_seconds(random_.uniform(kGreet_s / 5, 2 * kGreet_s)));
}

void Link::Impl::forget_silent(Instant now) {
  std::erase_if(remotes_, [&](const auto& entry) {
    if (now - entry.second.heard_at <= kForgetAfter) return false;
    counts_.lost += entry.second.stream.lost();
    return true;
  });
}

void Link::Impl::hear(const Author& from, std::span<const std::uint8_t> datagram, Instant now) {
  if (from == config_.self) return;
  auto rest = datagram;
  const auto head = read_head(rest);
  if (!head) {
    ++counts_.malformed;
    return;
  }
  Remote* const remote = remote_of(from, now);
  if (remote == nullptr) return;
  remote->heard_at = now;
  while (!rest.empty()) {
    const auto frame = read_frame(rest);
    if (!frame) {
      ++counts_.malformed;
      return;
    }
    on_frame(from, *remote, *frame, now);
  }
  remote->stream.on_head(*head, now, random_, deliver_from(from));
  note_questions(*remote);
}

void Link::Impl::on_frame(const Author& from, Remote& remote, const Frame& any, Instant now) {
  if (const auto* sample = std::get_if<SampleFrame>(&any)) {
    deliver_from(from)(sample->channel, sample->bytes);
  } else if (const auto* part = std::get_if<PartFrame>(&any)) {
    remote.stream.on_part(*part, deliver_from(from));
  } else if (const auto* hello = std::get_if<HelloFrame>(&any)) {
    on_hello(remote, *hello, now);
  } else if (const auto* certificate = std::get_if<CertificateFrame>(&any)) {
    remote.certificate = hash_of(certificate->bytes);
    remote.want_at.reset();
    sink_.on_certificate(from, certificate->bytes);
  } else if (const auto* missing = std::get_if<MissingFrame>(&any)) {
    on_missing(*missing, now);
  } else if (std::get<WantFrame>(any).author == config_.self && certificate_ != 0) {
    greet_with_certificate_ = true;
    greet(now);
  }
}

void Link::Impl::on_hello(Remote& remote, const HelloFrame& hello, Instant now) {
  remote.hello = hello;
  if (hello.certificate != 0 && hello.certificate != remote.certificate && !remote.want_at) {
    remote.want_at = now + from_seconds(random_.uniform(kWant_s, 2.0 * kWant_s));
  }
}

void Link::Impl::on_missing(const MissingFrame& missing, Instant now) {
  if (missing.author == config_.self) {
    if (!stream_.wants()) repairs_since_ = now;
    stream_.asked(missing, now);
    return;
  }
  const auto known = remotes_.find(missing.author);
  if (known != remotes_.end()) known->second.stream.on_asked(missing, now, random_);
}

std::vector<LinkPeer> Link::Impl::peers(Instant now) const {
  std::vector<LinkPeer> peers;
  for (const auto& [author, remote] : remotes_) {
    if (remote.hello && now - remote.heard_at <= kPeerFor) {
      peers.push_back({author, remote.hello->role});
    }
  }
  return peers;
}

// --- Link ----------------------------------------------------------------------------------------

Link::Link(LinkConfig config, LinkSink& sink, Instant now)
    : impl_{std::make_unique<Impl>(std::move(config), sink, now)} {}
Link::~Link() = default;
bool Link::send(std::uint8_t channel, std::vector<std::uint8_t> bytes, Instant now) {
  return impl_->send(channel, std::move(bytes), now);
}
void Link::hear(const Author& from, std::span<const std::uint8_t> datagram, Instant now) {
  impl_->hear(from, datagram, now);
}
Instant Link::due() const { return impl_->due(); }
std::optional<std::vector<std::uint8_t>> Link::poll(Instant now) { return impl_->poll(now); }
std::vector<LinkPeer> Link::peers(Instant now) const { return impl_->peers(now); }
const LinkCounts& Link::counts() const { return impl_->counts(); }

}  // namespace skein::air
