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
#include "introductions.hpp"
#include "out_stream.hpp"
#include "relay.hpp"
#include "repair_pace.hpp"
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
constexpr Duration kGreetShare = 10ms;  ///< or so long for each who is heard, where that is more
constexpr int kGreetings = 3;  ///< after somebody new was heard, for the case that one is lost
constexpr double kAgain_s = 0.3;
constexpr double kWant_s = 0.3;
constexpr Duration kForgetAfter = 60s;
/// What is missing may come by itself, at least for so long: over others later than directly.
constexpr Duration kMissingFor = 10ms;
constexpr Duration kMissingForOverHops = 50ms;
/// Who asks before it could have heard the last answer is answered by that one; how long its way
/// is, is not known here.
constexpr Duration kAnsweredMax = 60ms;
/// How often what is not asked for again is for those, too, who do not hear it themselves.
constexpr Duration kFarEvery = 900ms;
/// How far others' streams are is told so often, as long as it changed within kNewestFor.
constexpr double kNewest_s = 1.0;
constexpr Duration kNewestFor = 4s;
/// Who is heard over others is asked for this soon.
constexpr double kWantFar_s = 0.05;
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
        repair_pace_{config_.hops_max > 1 ? kMissingForOverHops : kMissingFor},
        hello_at_{now + from_seconds(random_.uniform(0.0, kGreet_s))},
        greet_with_certificate_{certificate_ != 0},
        far_at_(config_.channels.size() + 1),
        relay_{config_.self.node, config_.hops_max,
               config_.mtu_bytes - config_.overhead_bytes - kHeadBytes},
        tokens_{kBurst_s * config_.bytes_per_s.value_or(0.0)},
        filled_at_{now} {}

  bool send(std::uint8_t channel, std::vector<std::uint8_t> bytes, Instant now);
  void hear(const Opened& opened, std::span<const std::uint8_t> datagram, Instant now);
  [[nodiscard]] Instant due() const { return std::min(due_to_say(), due_to_pass_on()); }
  [[nodiscard]] std::optional<std::vector<std::uint8_t>> poll(Instant now);
  [[nodiscard]] std::vector<LinkPeer> peers(Instant now) const;
  [[nodiscard]] LinkCounts counts() const;

 private:
  struct Waiting {
    std::uint8_t channel = 0;
    std::vector<std::uint8_t> bytes;
    Instant since;
    std::size_t said = 0;  ///< of its bytes
  };
  struct Remote {
    Remote(RepairPace& pace, std::size_t channels) : stream{pace}, sampled(channels) {}
    InStream stream;
    std::vector<std::uint64_t> sampled;  ///< by channel, the newest datagram with a sample of it
    Instant heard_at;
    Instant newest_at;                 ///< when its stream was known to go on last
    std::optional<Instant> spread_at;  ///< when something of it was to be passed on
    std::optional<HelloFrame> hello;
    std::uint32_t certificate = 0;  ///< that was heard
    std::vector<std::uint8_t> certificate_bytes;
    std::optional<Instant> want_at;
    [[nodiscard]] bool is_known() const {
      return hello && (hello->certificate == 0 || hello->certificate == certificate);
    }
  };
  /// What a datagram held that was not known.
  struct News {
    std::vector<std::uint16_t> parts;
    bool who = false;
    Urgency urgency = Urgency::report;
  };

  [[nodiscard]] InStream::Deliver deliver_from(const Author& author) {
    return [this, &author](std::uint8_t channel, std::span<const std::uint8_t> bytes) {
      if (channel < config_.channels.size()) sink_.on_sample(channel, author, bytes);
    };
  }
  Remote* remote_of(const Passage& passage, Instant now);
  void forget_silent(Instant now);
  void greet(Instant now);
  [[nodiscard]] Duration greet_every() const;
  void on_datagram(const Passage& passage, const Opened& opened, Instant now);
  void on_frame(const Opened& opened, bool late, Remote& remote, const Frame& frame, News& news,
                Instant now);
  void on_sample(const Opened& opened, Remote& remote, const SampleFrame& sample);
  void on_hello(const Author& from, Remote& remote, const HelloFrame& hello, Instant now);
  void on_certificate(const Author& from, Remote& remote, std::span<const std::uint8_t> bytes,
                      Instant now);
  void on_neighbours_frame(const Author& from, const Frame& frame, Instant now);
  void on_missing(VehicleId asker, const MissingFrame& missing, Instant now);
  void on_want(VehicleId asker, const WantFrame& want, Instant now);
  void on_passed_on(VehicleId transmitter, const PassedOnFrame& passed_on, Instant now);
  void on_introduction(VehicleId teller, const IntroductionFrame& frame, Instant now);

  [[nodiscard]] Instant when_affordable(Urgency urgency, Instant from) const;
  void refill(Instant now);

  [[nodiscard]] Instant due_to_say() const;
  [[nodiscard]] Instant due_to_pass_on() const;
  void say(Instant now);
  void pass_on(Instant now);

  [[nodiscard]] std::size_t room() const { return out_max_ - out_.size(); }
  void begin(std::size_t bytes_max);
  [[nodiscard]] std::optional<std::vector<std::uint8_t>> finished(bool far);
  bool put(const Frame& frame);
  void put_greeting(Instant now);
  void put_questions(Instant now);
  void note_questions(const Remote& remote);
  void put_repairs(Instant now);
  void put_waiting(Urgency urgency, Instant now);
  bool put_part(Waiting& waiting, Instant now);
  void put_introductions(Instant now);
  void put_newest(Instant now);
  [[nodiscard]] bool is_far(Instant now);

  const LinkConfig config_;
  LinkSink& sink_;
  Random random_;
  const std::uint32_t certificate_;

  std::array<std::deque<Waiting>, kUrgencies> waiting_;
  std::optional<Waiting> begun_;  ///< some parts of it were said; the others must follow
  OutStream stream_;
  Instant repairs_since_;
  RepairPace repair_pace_;  ///< before what learns from it
  std::map<Author, Remote> remotes_;
  std::optional<Instant> questions_at_;  ///< no question of any remote is due before

  Instant hello_at_;
  std::optional<Instant> greeted_at_;
  bool greet_with_certificate_;
  int greetings_ = kGreetings;  ///< that are to follow soon

  /// When each channel's samples, and at last a hello, were said to those who do not hear us.
  std::vector<std::optional<Instant>> far_at_;
  Relay relay_;
  Introductions introductions_;
  Instant listener_at_;               ///< when somebody new heard us
  std::optional<Instant> newest_at_;  ///< how far others are is to be told
  Author newest_told_{};              ///< of whom it was told last

  double tokens_;
  Instant filled_at_;
  // The datagram that is being made.
  std::vector<std::uint8_t> out_;
  std::size_t out_max_ = 0;
  std::vector<std::size_t> out_samples_;  ///< places in far_at_
  bool out_has_parts_ = false;            ///< said for the first time
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

Instant Link::Impl::due_to_say() const {
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

Instant Link::Impl::due_to_pass_on() const {
  Instant due = Instant::max();
  const auto sooner = [&](Urgency urgency, const std::optional<Instant>& at) {
    if (at) due = std::min(due, when_affordable(urgency, *at));
  };
  sooner(Urgency::decision, introductions_.due());
  sooner(Urgency::state, newest_at_);
  for (std::size_t u = 0; u < kUrgencies; ++u) {
    sooner(static_cast<Urgency>(u), relay_.due(static_cast<Urgency>(u)));
  }
  return due;
}

std::optional<std::vector<std::uint8_t>> Link::Impl::poll(Instant now) {
  refill(now);
  if (now >= due_to_say()) {
    say(now);
    if (auto said = finished(is_far(now))) return said;
  }
  if (now < due_to_pass_on()) return std::nullopt;
  pass_on(now);
  return finished(false);
}

void Link::Impl::say(Instant now) {
  begin(config_.datagram_bytes);
  stream_.forget(now);
  put_greeting(now);
  if (begun_ && put_part(*begun_, now)) begun_.reset();
  if (questions_at_ && now >= *questions_at_) put_questions(now);
  if (begun_) return;
  put_repairs(now);
  for (std::size_t u = 0; u < kUrgencies; ++u) {
    const auto urgency = static_cast<Urgency>(u);
    if (when_affordable(urgency, now) > now) break;
    put_waiting(urgency, now);
  }
}

/// What only neighbours are to hear goes with it.
void Link::Impl::pass_on(Instant now) {
  begin(config_.mtu_bytes - config_.overhead_bytes);
  put_introductions(now);
  if (newest_at_ && now >= *newest_at_) put_newest(now);
  for (std::size_t u = 0; u < kUrgencies; ++u) {
    const auto urgency = static_cast<Urgency>(u);
    if (when_affordable(urgency, now) > now) break;
    while (const auto frame = relay_.take(urgency, now, room())) {
      (void)put(*frame);
      ++counts_.passed_on;
    }
  }
}

void Link::Impl::begin(std::size_t bytes_max) {
  out_.clear();
  out_max_ = bytes_max;
  out_samples_.clear();
  out_has_parts_ = false;
  write(out_, Head{});  // what it says is known at the end
}

std::optional<std::vector<std::uint8_t>> Link::Impl::finished(bool far) {
  if (out_.size() == kHeadBytes) return std::nullopt;
  Head head = stream_.head();
  head.far = far;
  std::vector<std::uint8_t> bytes;
  write(bytes, head);
  std::ranges::copy(bytes, out_.begin());
  const std::size_t size = out_.size() + config_.overhead_bytes;
  tokens_ -= static_cast<double>(size);
  ++counts_.datagrams;
  counts_.bytes += size;
  return out_;
}

/// Parts are passed on to who misses them, and with them what else their datagram says.
bool Link::Impl::is_far(Instant now) {
  const bool far = std::ranges::any_of(out_samples_, [&](std::size_t of) {
    return !far_at_[of] || now - *far_at_[of] >= kFarEvery;
  });
  if (far || out_has_parts_) {
    for (const std::size_t of : out_samples_) far_at_[of] = now;
    far_at_.back() = now;  // that we are there is said by anything
  }
  return far;
}

bool Link::Impl::put(const Frame& frame) {
  if (size_of(frame) > room()) return false;
  write(out_, frame);
  return true;
}

void Link::Impl::put_greeting(Instant now) {
  if (now < hello_at_ - kHelloEarly) return;
  if (put(HelloFrame{config_.role, certificate_})) out_samples_.push_back(far_at_.size() - 1);
  if (relay_.passes()) {
    relay_.neighbours.tell_hearing([this](const HearingFrame& hearing) { (void)put(hearing); });
  }
  if (greet_with_certificate_)
    greet_with_certificate_ = !put(CertificateFrame{config_.certificate});
  forget_silent(now);
  greeted_at_ = now;
  const double next_s = greetings_ > 0 ? std::max(kAgain_s, to_seconds(greet_every())) : kHello_s;
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
    if (at && now >= *at) {
      while (room() >= size_of(MissingFrame{})) {
        const auto missing = remote.stream.ask(author, now, random_);
        if (!missing) break;
        (void)put(*missing);
      }
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
    } else if (put(SampleFrame{waiting->channel, waiting->bytes})) {
      out_samples_.push_back(waiting->channel);
    } else {
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
  out_has_parts_ = true;
  waiting.said += size;
  return size == left;
}

void Link::Impl::put_introductions(Instant now) {
  while (const auto author = introductions_.next(now)) {
    const auto known = remotes_.find(*author);
    if (known != remotes_.end() && known->second.hello &&
        !put(IntroductionFrame{*author, known->second.hello->role,
                               known->second.certificate_bytes}) &&
        out_.size() > kHeadBytes) {
      return;  // in the next datagram
    }
    introductions_.done(*author);
  }
}

void Link::Impl::put_newest(Instant now) {
  newest_at_.reset();
  auto next = remotes_.upper_bound(newest_told_);
  for (std::size_t left = remotes_.size(); left > 0; --left, ++next) {
    if (next == remotes_.end()) next = remotes_.begin();
    const auto& [author, remote] = *next;
    const auto newest = remote.stream.newest();
    if (!newest || now - remote.newest_at > kNewestFor) continue;
    if (!newest_at_) newest_at_ = now + from_seconds(kNewest_s * random_.uniform(0.9, 1.1));
    if (relay_.neighbours.without(author.node).empty()) continue;
    if (!put(NewestFrame{author, *newest})) return;  // next time
    newest_told_ = author;
  }
}

// --- what is heard -------------------------------------------------------------------------------

Link::Impl::Remote* Link::Impl::remote_of(const Passage& passage, Instant now) {
  const auto known = remotes_.find(passage.author);
  if (known != remotes_.end()) return &known->second;
  if (passage.late) return nullptr;  // it may be gone
  if (remotes_.size() >= kAuthorsMax) {
    ++counts_.too_many;
    return nullptr;
  }
  Remote& remote =
      remotes_.try_emplace(passage.author, repair_pace_, config_.channels.size()).first->second;
  if (passage.transmitter == passage.author.node) {
    greet_with_certificate_ = certificate_ != 0;
    greetings_ = kGreetings;
    greet(now);
  } else {  // it does not hear us
    remote.want_at = now + from_seconds(random_.uniform(kWantFar_s, 2.0 * kWantFar_s));
  }
  return &remote;
}

/// All greet whoever is new; together they take no more of the air the more they are.
Duration Link::Impl::greet_every() const {
  return std::max(kGreetEvery, kGreetShare * static_cast<std::int64_t>(remotes_.size()));
}

/// Somebody should hear of us soon.
void Link::Impl::greet(Instant now) {
  const Instant earliest = greeted_at_ ? std::max(now, *greeted_at_ + greet_every()) : now;
  hello_at_ =
      std::min(hello_at_, earliest + from_seconds(random_.uniform(kGreet_s / 5, 2 * kGreet_s)));
}

void Link::Impl::forget_silent(Instant now) {
  relay_.forget(now);
  introductions_.forget(now);
  std::erase_if(remotes_, [&](const auto& entry) {
    if (now - entry.second.heard_at <= kForgetAfter) return false;
    counts_.lost += entry.second.stream.lost();
    return true;
  });
}

void Link::Impl::hear(const Opened& opened, std::span<const std::uint8_t> datagram, Instant now) {
  const Author& from = opened.author;
  if (from == config_.self) return;
  if (relay_.passes() && relay_.neighbours.heard(from, now)) greet(now);
  on_datagram({from, from.node, relay_.hops(), false, datagram}, opened, now);
}

void Link::Impl::on_datagram(const Passage& passage, const Opened& opened, Instant now) {
  auto rest = *opened.content;
  const auto head = read_head(rest);
  if (!head) {
    ++counts_.malformed;
    return;
  }
  const Author& from = passage.author;
  Remote* const remote = remote_of(passage, now);
  if (remote == nullptr) return;
  if (!passage.late) remote->heard_at = now;
  const auto newest = remote->stream.newest();
  News news;
  while (!rest.empty()) {
    const auto frame = read_frame(rest);
    if (!frame) {
      ++counts_.malformed;
      return;
    }
    if (passage.late && !std::holds_alternative<PartFrame>(*frame)) continue;
    if (passage.transmitter == from.node) on_neighbours_frame(from, *frame, now);
    on_frame(opened, passage.late, *remote, *frame, news, now);
  }
  remote->stream.on_head(*head, now, random_, deliver_from(from));
  if (relay_.passes() && remote->stream.newest() != newest) {
    remote->newest_at = now;
    if (!newest_at_) newest_at_ = now + from_seconds(kNewest_s * random_.uniform(0.9, 1.1));
  }
  note_questions(*remote);
  const bool is_for_all = !passage.late && (head->far || news.who || !remote->spread_at ||
                                            *remote->spread_at <= listener_at_);
  const bool spreads = is_for_all || !news.parts.empty();
  if (spreads && !passage.late) remote->spread_at = now;
  relay_.on_first(passage, std::move(news.parts), spreads, news.urgency, now, random_);
}

void Link::Impl::on_frame(const Opened& opened, bool late, Remote& remote, const Frame& any,
                          News& news, Instant now) {
  const Author& from = opened.author;
  const auto note_urgency = [&](std::uint8_t channel) {
    if (channel < config_.channels.size()) {
      news.urgency = std::min(news.urgency, config_.channels[channel].urgency);
    }
  };
  if (const auto* sample = std::get_if<SampleFrame>(&any)) {
    note_urgency(sample->channel);
    on_sample(opened, remote, *sample);
  } else if (const auto* part = std::get_if<PartFrame>(&any)) {
    note_urgency(part->channel);
    if (remote.stream.on_part(*part, late, now, random_, deliver_from(from))) {
      news.parts.push_back(part->number);
    }
  } else if (const auto* hello = std::get_if<HelloFrame>(&any)) {
    news.who = news.who || remote.hello != *hello;
    on_hello(from, remote, *hello, now);
  } else if (const auto* certificate = std::get_if<CertificateFrame>(&any)) {
    news.who = news.who || remote.certificate != hash_of(certificate->bytes);
    on_certificate(from, remote, certificate->bytes, now);
  }
  if (news.who) news.urgency = Urgency::decision;
}

/// What was overtaken on its way is not told as if it were of now.
void Link::Impl::on_sample(const Opened& opened, Remote& remote, const SampleFrame& sample) {
  if (sample.channel >= remote.sampled.size()) return;
  std::uint64_t& newest = remote.sampled[sample.channel];
  if (opened.counter < newest) return;
  newest = opened.counter;
  sink_.on_sample(sample.channel, opened.author, sample.bytes);
}

void Link::Impl::on_hello(const Author& from, Remote& remote, const HelloFrame& hello,
                          Instant now) {
  remote.hello = hello;
  if (remote.is_known()) {
    remote.want_at.reset();
    introductions_.known(from, now, random_);
  } else if (!remote.want_at) {
    remote.want_at = now + from_seconds(random_.uniform(kWant_s, 2.0 * kWant_s));
  }
}

void Link::Impl::on_certificate(const Author& from, Remote& remote,
                                std::span<const std::uint8_t> bytes, Instant now) {
  remote.certificate = hash_of(bytes);
  if (relay_.passes()) remote.certificate_bytes.assign(bytes.begin(), bytes.end());
  if (remote.is_known()) {
    remote.want_at.reset();
    introductions_.known(from, now, random_);
  }
  sink_.on_certificate(from, bytes);
}

/// What is not for those who do not hear its author.
void Link::Impl::on_neighbours_frame(const Author& from, const Frame& any, Instant now) {
  if (const auto* missing = std::get_if<MissingFrame>(&any)) {
    on_missing(from.node, *missing, now);
  } else if (const auto* want = std::get_if<WantFrame>(&any)) {
    on_want(from.node, *want, now);
  } else if (const auto* passed_on = std::get_if<PassedOnFrame>(&any)) {
    on_passed_on(from.node, *passed_on, now);
  } else if (const auto* hearing = std::get_if<HearingFrame>(&any)) {
    if (relay_.neighbours.on_hearing(from.node, *hearing)) listener_at_ = now;
  } else if (const auto* introduction = std::get_if<IntroductionFrame>(&any)) {
    on_introduction(from.node, *introduction, now);
  } else if (const auto* newest = std::get_if<NewestFrame>(&any)) {
    const auto known = remotes_.find(newest->author);
    if (known == remotes_.end() || !relay_.passes()) return;
    known->second.stream.on_newest(newest->newest, now, random_);
    note_questions(known->second);
  }
}

void Link::Impl::on_missing(VehicleId asker, const MissingFrame& missing, Instant now) {
  if (missing.author == config_.self) {
    if (!stream_.wants()) repairs_since_ = now;
    stream_.asked(missing, std::min(repair_pace_.round_trip(), kAnsweredMax), now);
    return;
  }
  const auto known = remotes_.find(missing.author);
  if (known != remotes_.end()) known->second.stream.on_asked(missing, now, random_);
  relay_.on_missing(asker, missing, now, random_);
}

/// Its author is left to answer whom it is heard by.
void Link::Impl::on_want(VehicleId asker, const WantFrame& want, Instant now) {
  const Neighbours& neighbours = relay_.neighbours;
  if (want.author == config_.self) {
    greet_with_certificate_ = certificate_ != 0;
    greet(now);
  } else if (neighbours.hears(asker, config_.self.node) &&
             !neighbours.hears(asker, want.author.node)) {
    const auto known = remotes_.find(want.author);
    const bool is_known = known != remotes_.end() && known->second.is_known();
    introductions_.asked(want.author, asker, is_known, now, random_);
  }
}

void Link::Impl::on_passed_on(VehicleId transmitter, const PassedOnFrame& passed_on, Instant now) {
  const auto opened = sink_.open(passed_on.bytes);
  if (!opened || opened->author == config_.self || opened->author.node == transmitter) return;
  const Passage passage{opened->author, transmitter, std::min(passed_on.hops, relay_.hops()),
                        passed_on.late, passed_on.bytes};
  if (opened->content) {
    on_datagram(passage, *opened, now);
  } else {
    relay_.on_copy(passage);
  }
}

/// What its author says itself counts more.
void Link::Impl::on_introduction(VehicleId teller, const IntroductionFrame& frame, Instant now) {
  introductions_.told(frame.author, teller, relay_.neighbours);
  const auto known = remotes_.find(frame.author);
  if (known == remotes_.end() || known->second.is_known()) return;
  Remote& remote = known->second;
  if (!frame.certificate.empty()) on_certificate(frame.author, remote, frame.certificate, now);
  if (!remote.hello) on_hello(frame.author, remote, {frame.role, remote.certificate}, now);
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

LinkCounts Link::Impl::counts() const {
  LinkCounts counts = counts_;
  counts.gave_way += relay_.gave_way();
  for (const auto& [author, remote] : remotes_) counts.lost += remote.stream.lost();
  return counts;
}

// --- Link ----------------------------------------------------------------------------------------

Link::Link(LinkConfig config, LinkSink& sink, Instant now)
    : impl_{std::make_unique<Impl>(std::move(config), sink, now)} {}
Link::~Link() = default;
bool Link::send(std::uint8_t channel, std::vector<std::uint8_t> bytes, Instant now) {
  return impl_->send(channel, std::move(bytes), now);
}
void Link::hear(const Opened& opened, std::span<const std::uint8_t> datagram, Instant now) {
  impl_->hear(opened, datagram, now);
}
Instant Link::due() const { return impl_->due(); }
std::optional<std::vector<std::uint8_t>> Link::poll(Instant now) { return impl_->poll(now); }
std::vector<LinkPeer> Link::peers(Instant now) const { return impl_->peers(now); }
LinkCounts Link::counts() const { return impl_->counts(); }

}  // namespace skein::air
