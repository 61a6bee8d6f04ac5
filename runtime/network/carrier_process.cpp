// SPDX-License-Identifier: Apache-2.0
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include "carrier_check.hpp"
#include "carrier_messages.hpp"
#include "carrier_start.hpp"
#include "key_news_desk.hpp"
#include "processor_wait.hpp"
#include "skein/base/assert.hpp"

namespace skein::network {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr milliseconds kPingPeriod{100};
/// So long without an answer, and it is ended. Twice as long after it was once, up to the third.
/// Only what tells of the child counts: not while it computes or is ready to, until the last; a new
/// child costs a busy machine more than patience.
constexpr milliseconds kSilentFor{300};
constexpr milliseconds kSilentForMax{1200};
constexpr milliseconds kSilentOnBusyMax{10'000};
constexpr milliseconds kBusy{5};      ///< of kPingPeriod without a processor
constexpr milliseconds kComputes{1};  ///< of kPingPeriod
/// Of time in which it neither computes nor waits for a processor.
constexpr seconds kJoinsWithin{10};
constexpr seconds kJoinsOnBusyMax{120};
/// Who lives so long is started again at once; the others wait, twice as long each time.
constexpr seconds kLongLife{10};
constexpr seconds kCalmLife{60};  ///< after which silence is judged as at first
constexpr milliseconds kAgainAfter{50};
constexpr milliseconds kAgainAfterMax{1000};
/// What comes within this after something was read is read in one go: a wake-up costs ten times as
/// much as a message. Less than the agent's period.
constexpr milliseconds kReadSpacing{30};
constexpr int kReadAtOnce = 256;  ///< then it is seen to pings
constexpr int kLeavesWithinMs = 1000;
/// How many counters a child may seal with before it is heard of again: a second's and more. What
/// is left of them when it dies is never used.
constexpr std::uint64_t kCounterLease = 1U << 16U;
constexpr std::size_t kTroublesMax = 16;
constexpr std::size_t kNewsMax = KeyNewsDesk::kHeardMax;

std::string seconds_text(Clock::duration d) {
  const auto ms = std::chrono::duration_cast<milliseconds>(d).count();
  const std::string rest = std::to_string(1000 + ms % 1000);
  return std::to_string(ms / 1000) + "." + rest.substr(1, 2) + " s";
}

/// Keeps a child that carries the network: talks to it, watches it, starts the next.
class CarrierProcess final : public Carrier {
 public:
  CarrierProcess(CarrierConfig config, CarrierSink& sink)
      : config_{std::move(config)},
        sink_{sink},
        wake_{eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)},
        buffer_(kCarrierMessageBytesMax) {
    if (config_.seal) key_ = config_.seal->key;
    thread_ = std::thread{[this] { run(); }};
  }
  ~CarrierProcess() override {
    ending_ = true;
    wake();
    thread_.join();
  }
  CarrierProcess(const CarrierProcess&) = delete;
  CarrierProcess& operator=(const CarrierProcess&) = delete;

  /// Until the first child has joined, or why it has not.
  Result<void> wait_for_first() {
    std::unique_lock lock{mutex_};
    first_known_.wait(lock, [this] { return first_.has_value(); });
    return first_->empty() ? Result<void>{} : Result<void>{Error{*first_}};
  }

  [[nodiscard]] Written write(codec::Topic topic, std::vector<std::uint8_t> bytes) override;
  [[nodiscard]] std::vector<Peer> peers() const override;
  [[nodiscard]] std::vector<Reception> receptions() const override;
  void change_key(const seal::EpochKey& key, Duration old_for) override;
  void tell(const std::vector<KeyNews>& news) override;
  [[nodiscard]] std::optional<std::vector<std::uint8_t>> take_key_news() override;
  [[nodiscard]] CarrierCounts counts() const override;
  [[nodiscard]] std::vector<std::string> take_troubles() override;
  [[nodiscard]] std::uint64_t restarts() const override { return restarts_.load(); }

 private:
  struct Life {
    explicit Life(CarrierChild one) : child{std::move(one)} {}
    CarrierChild child;
    Clock::time_point born = Clock::now();
    Clock::time_point next_ping = born;
    Clock::time_point next_read = born;
    std::uint32_t pings = 0;
    std::uint32_t answered = 0;
    milliseconds silent{0};      ///< so far as it counts
    milliseconds unanswered{0};  ///< all of it
    std::chrono::nanoseconds computed{0};
    bool joined = false;
    bool over = false;
    std::string why;  ///< it is over; empty: as its process says
    [[nodiscard]] Clock::duration age() const { return Clock::now() - born; }
    void end(std::string reason) {
      over = true;
      why = std::move(reason);
    }
  };

  void run();
  /// Why it ended.
  [[nodiscard]] std::string live();
  void serve(Life& life);
  void wait(const Life& life, bool& readable, bool& ended);
  void read(Life& life, int most);
  void flush(Life& life);
  void watch(Life& life);
  void ping(Life& life);
  void mourn(const std::string& why, bool had_joined, Clock::time_point at);
  void rest(milliseconds at_most);
  void wake() const;

  void take(Life& life, const Joined& joined);
  void take(Life& life, const Refused& refused) { life.end(refused.why); }
  void take(Life& life, const Stuck&) { life.end("a thread of it hung"); }
  void take(Life&, const HeardSample& heard) {
    sink_.on_sample(heard.topic, heard.sender, heard.instance, heard.bytes);
  }
  void take(Life&, const HeardCertificate& heard) { sink_.on_certificate(heard.bytes); }
  void take(Life&, const HeardNews& heard);
  void take(Life&, const PeersNow& now) {
    const std::lock_guard lock{mutex_};
    peers_ = now.peers;
  }
  void take(Life&, const ReceptionsNow& now) {
    const std::lock_guard lock{mutex_};
    receptions_ = now.receptions;
  }
  void take(Life& life, const Pong& pong);

  /// With the key that counts, and counters that none before had. Of the child's thread.
  [[nodiscard]] CarrierConfig next_config();
  /// Precondition of these: the lock is held.
  void say_key_and_news();
  void say(const ToCarrier& message) { outbox_.push_back(to_bytes(message)); }
  [[nodiscard]] Duration old_key_left() const {
    return std::max(Duration{}, std::chrono::duration_cast<Duration>(old_until_ - Clock::now()));
  }
  void note(std::string trouble);
  void know_first(std::string why_not);

  const CarrierConfig config_;
  CarrierSink& sink_;
  const system::Descriptor wake_;
  std::atomic<bool> ending_{false};
  std::atomic<std::uint64_t> restarts_{0};

  mutable std::mutex mutex_;  ///< of what follows, up to the next line
  std::condition_variable first_known_;
  std::optional<std::string> first_;  ///< how the first child did: empty is well
  int up_ = -1;                       ///< socket of a child that has joined
  std::deque<std::vector<std::uint8_t>> outbox_;
  std::optional<seal::EpochKey> key_;
  std::optional<seal::EpochKey> old_key_;
  Clock::time_point old_until_{};
  std::vector<KeyNews> news_;
  std::vector<Peer> peers_;
  std::vector<Reception> receptions_;
  std::deque<std::vector<std::uint8_t>> heard_news_;
  CarrierCounts counts_{};  ///< of this child
  CarrierCounts counts_before_{};
  std::vector<std::string> troubles_;
  std::string last_trouble_;

  // The thread's own.
  std::vector<std::uint8_t> buffer_;
  std::optional<ProcessorWait> waited_;
  std::uint8_t next_run_ = 0;
  std::uint64_t counters_end_ = 0;  ///< of those that any child was given
  std::string lost_by_;             ///< why the one before is gone; empty: there was none
  Clock::time_point lost_at_{};
  milliseconds silent_for_{kSilentFor};
  milliseconds again_after_{0};
  std::thread thread_;
};

// --- what others call ---------------------------------------------------------------------------

Written CarrierProcess::write(codec::Topic topic, std::vector<std::uint8_t> bytes) {
  const auto message = to_bytes(ToCarrier{WriteSample{topic, bytes}});
  const std::lock_guard lock{mutex_};
  if (up_ < 0) return Written::no_network;
  if (send(up_, message.data(), message.size(), MSG_DONTWAIT | MSG_NOSIGNAL) >= 0) {
    return Written::yes;
  }
  return errno == EAGAIN ? Written::no_room : Written::no_network;
}

std::vector<Peer> CarrierProcess::peers() const {
  const std::lock_guard lock{mutex_};
  return peers_;
}

std::vector<Reception> CarrierProcess::receptions() const {
  const std::lock_guard lock{mutex_};
  return receptions_;
}

void CarrierProcess::change_key(const seal::EpochKey& key, Duration old_for) {
  {
    const std::lock_guard lock{mutex_};
    SKEIN_ASSERT(key_);
    old_key_ = std::exchange(key_, key);
    old_until_ = Clock::now() + old_for;
    if (up_ >= 0) say(ChangeKey{key, old_for});
  }
  wake();
}

void CarrierProcess::tell(const std::vector<KeyNews>& news) {
  {
    const std::lock_guard lock{mutex_};
    news_ = news;
    if (up_ < 0) return;
    say(ForgetNews{});
    for (const KeyNews& one : news_) say(TellNews{one, &one == &news_.back()});
  }
  wake();
}

std::optional<std::vector<std::uint8_t>> CarrierProcess::take_key_news() {
  const std::lock_guard lock{mutex_};
  if (heard_news_.empty()) return std::nullopt;
  auto first = std::move(heard_news_.front());
  heard_news_.pop_front();
  return first;
}

CarrierCounts CarrierProcess::counts() const {
  const std::lock_guard lock{mutex_};
  CarrierCounts sum = counts_before_;
  for (std::size_t i = 0; i < sum.size(); ++i) sum.at(i) += counts_.at(i);
  return sum;
}

std::vector<std::string> CarrierProcess::take_troubles() {
  const std::lock_guard lock{mutex_};
  return std::exchange(troubles_, {});
}

void CarrierProcess::wake() const {
  const std::uint64_t one = 1;
  (void)!::write(wake_.get(), &one, sizeof one);
}

// --- one child after the other ------------------------------------------------------------------

void CarrierProcess::run() {
  waited_.emplace();
  while (!ending_) {
    const std::string why = live();
    if (ending_) break;
    {
      const std::lock_guard lock{mutex_};
      if (!first_) {
        first_ = why;
        first_known_.notify_all();
        return;  // whoever opens it is told, and closes it
      }
    }
    rest(again_after_);
  }
  know_first("it was closed");
}

void CarrierProcess::know_first(std::string why_not) {
  const std::lock_guard lock{mutex_};
  if (!first_) first_ = std::move(why_not);
  first_known_.notify_all();
}

std::string CarrierProcess::live() {
  auto child = CarrierChild::start(config_.self);
  if (!child) {
    mourn(child.error().message, false, Clock::now());
    again_after_ = kAgainAfterMax;
    return child.error().message;
  }
  Life life{std::move(child).value()};
  const auto config = to_bytes(ToCarrier{next_config()});
  (void)send(life.child.socket(), config.data(), config.size(), MSG_NOSIGNAL);
  serve(life);
  {
    const std::lock_guard lock{mutex_};
    up_ = -1;
    outbox_.clear();
    peers_.clear();
    receptions_.clear();
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_before_.at(i) += counts_.at(i);
    counts_ = {};
  }
  if (ending_) {
    life.child.end_in_order(kLeavesWithinMs);
    return {};
  }
  const std::string how = life.child.end();
  if (life.why.empty()) life.why = how;
  if (life.silent >= silent_for_) silent_for_ = std::min(2 * silent_for_, kSilentForMax);
  again_after_ = life.age() > kLongLife ? milliseconds{0}
                                        : std::clamp(2 * again_after_, kAgainAfter, kAgainAfterMax);
  mourn(life.why, life.joined, Clock::now() - life.unanswered);
  return life.why;
}

void CarrierProcess::mourn(const std::string& why, bool had_joined, Clock::time_point at) {
  if (had_joined || lost_by_.empty()) lost_at_ = at;
  if (!had_joined && !lost_by_.empty()) {
    const std::lock_guard lock{mutex_};
    note("the process that carries the network cannot join it again, and is tried once more: " +
         why);
  }
  lost_by_ = why;
}

void CarrierProcess::note(std::string trouble) {
  if (troubles_.size() >= kTroublesMax || trouble == last_trouble_) return;
  last_trouble_ = trouble;
  troubles_.push_back(std::move(trouble));
}

void CarrierProcess::rest(milliseconds at_most) {
  const auto end = Clock::now() + at_most;
  for (auto left = at_most; left.count() > 0 && !ending_;
       left = std::chrono::ceil<milliseconds>(end - Clock::now())) {
    pollfd item{wake_.get(), POLLIN, 0};
    if (poll(&item, 1, static_cast<int>(left.count())) > 0) {
      std::uint64_t count = 0;
      (void)!::read(wake_.get(), &count, sizeof count);
    }
  }
}

CarrierConfig CarrierProcess::next_config() {
  CarrierConfig config = config_;
  config.run = next_run_++;
  if (!config.seal) return config;
  config.seal->counters = {counters_end_, counters_end_ + kCounterLease};
  counters_end_ = config.seal->counters.end;
  const std::lock_guard lock{mutex_};
  // It begins with the older key while that is understood, and is told of the other when it has
  // joined.
  config.seal->key = old_key_ && old_key_left() > Duration{} ? *old_key_ : *key_;
  return config;
}

// --- one child ----------------------------------------------------------------------------------

void CarrierProcess::serve(Life& life) {
  while (!life.over && !ending_) {
    bool readable = false;
    bool ended = false;
    wait(life, readable, ended);
    if (readable) read(life, kReadAtOnce);
    if (ended) {
      read(life, kReadAtOnce);  // its last words
      life.over = true;
    }
    if (life.over) return;
    flush(life);
    watch(life);
  }
}

void CarrierProcess::wait(const Life& life, bool& readable, bool& ended) {
  const auto now = Clock::now();
  const bool rests = now < life.next_read;
  bool waits_to_say = false;
  {
    const std::lock_guard lock{mutex_};
    waits_to_say = !outbox_.empty();
  }
  const auto until = rests ? std::min(life.next_read, life.next_ping) : life.next_ping;
  const auto left = std::max(Clock::duration{}, until - now);
  std::array<pollfd, 3> items{
      pollfd{rests ? -1 : life.child.socket(),
             static_cast<short>(waits_to_say ? POLLIN | POLLOUT : POLLIN), 0},
      pollfd{life.child.ended(), POLLIN, 0}, pollfd{wake_.get(), POLLIN, 0}};
  const timespec timeout{
      std::chrono::duration_cast<seconds>(left).count(),
      std::chrono::duration_cast<std::chrono::nanoseconds>(left % seconds{1}).count()};
  if (ppoll(items.data(), items.size(), &timeout, nullptr) <= 0) return;
  readable = (items[0].revents & (POLLIN | POLLHUP | POLLERR)) != 0;
  ended = items[1].revents != 0;
  if (items[2].revents != 0) {
    std::uint64_t count = 0;
    (void)!::read(wake_.get(), &count, sizeof count);
  }
}

void CarrierProcess::read(Life& life, int most) {
  for (int i = 0; i < most && !life.over; ++i) {
    const ssize_t size =
        recv(life.child.socket(), buffer_.data(), buffer_.size(), MSG_DONTWAIT | MSG_TRUNC);
    if (size < 0 && errno == EINTR) continue;
    if (size < 0 && errno == EAGAIN) break;
    if (size <= 0) {
      life.over = true;
      return;
    }
    const auto whole = static_cast<std::size_t>(size) <= buffer_.size();
    const auto message =
        whole ? from_carrier_from({buffer_.data(), static_cast<std::size_t>(size)}) : std::nullopt;
    if (!message) return life.end("it said what is no message of ours");
    std::visit([this, &life](const auto& m) { take(life, m); }, *message);
  }
  life.next_read = Clock::now() + kReadSpacing;
}

void CarrierProcess::flush(Life& life) {
  const std::lock_guard lock{mutex_};
  while (!outbox_.empty()) {
    const auto& next = outbox_.front();
    if (send(life.child.socket(), next.data(), next.size(), MSG_DONTWAIT | MSG_NOSIGNAL) < 0)
      return;
    outbox_.pop_front();
  }
}

void CarrierProcess::watch(Life& life) {
  const auto now = Clock::now();
  if (now < life.next_ping) return;
  const bool had_to_wait = waited_->since_last() > kBusy;
  life.next_ping = now + kPingPeriod;
  const auto before = std::exchange(life.computed, life.child.computed());
  const bool answers = life.joined && life.answered == life.pings;
  const bool tells = !answers && life.computed - before < kComputes &&
                     !life.child.is_ready().value_or(had_to_wait || is_machine_overloaded());
  if (!life.joined) {
    if (tells) life.silent += kPingPeriod;
    if (life.silent > kJoinsWithin || life.age() > kJoinsOnBusyMax) {
      life.end("it did not join within " + seconds_text(life.age()));
    }
    return;
  }
  if (life.age() > kCalmLife) silent_for_ = kSilentFor;
  if (life.answered == life.pings) {
    life.silent = life.unanswered = milliseconds{0};
  } else {
    life.unanswered += kPingPeriod;
    if (tells) life.silent += kPingPeriod;
  }
  if (life.silent >= silent_for_ || life.unanswered >= kSilentOnBusyMax) {
    return life.end("it was silent for " + seconds_text(life.unanswered));
  }
  ping(life);
}

void CarrierProcess::ping(Life& life) {
  const auto message = to_bytes(ToCarrier{Ping{++life.pings, counters_end_}});
  (void)send(life.child.socket(), message.data(), message.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
}

void CarrierProcess::take(Life& life, const Joined& joined) {
  if (std::exchange(life.joined, true)) return;
  life.silent = milliseconds{0};
  {
    const std::lock_guard lock{mutex_};
    up_ = life.child.socket();
    say_key_and_news();
    if (!joined.unconfined.empty()) {
      note("the process that carries the network has more rights than it should: " +
           joined.unconfined);
    }
    if (!lost_by_.empty()) {
      ++restarts_;
      note("the process that carries the network ended: " + lost_by_ +
           "; started again, its network was gone for " + seconds_text(Clock::now() - lost_at_) +
           " (restart " + std::to_string(restarts_) + ")");
    }
  }
  ping(life);
  life.next_ping = Clock::now() + kPingPeriod;
  know_first({});
}

void CarrierProcess::say_key_and_news() {
  if (old_key_) say(ChangeKey{*key_, old_key_left()});
  for (const KeyNews& one : news_) say(TellNews{one, &one == &news_.back()});
}

void CarrierProcess::take(Life&, const HeardNews& heard) {
  if (!is_key_news(heard.bytes)) return;
  const std::lock_guard lock{mutex_};
  const bool known = std::ranges::any_of(heard_news_, [&heard](const auto& waiting) {
    return std::ranges::equal(waiting, heard.bytes);
  });
  if (known || heard_news_.size() >= kNewsMax) return;
  heard_news_.emplace_back(heard.bytes.begin(), heard.bytes.end());
}

void CarrierProcess::take(Life& life, const Pong& pong) {
  if (pong.number <= life.pings) life.answered = std::max(life.answered, pong.number);
  // It is believed no more than it was given.
  const std::uint64_t used = std::min(pong.next_counter, counters_end_);
  counters_end_ = std::min(std::max(counters_end_, used + kCounterLease), seal::kCounterMax + 1);
  const std::lock_guard lock{mutex_};
  counts_ = pong.counts;
}

}  // namespace

Result<std::unique_ptr<Carrier>> open_carrier_process(CarrierConfig config, CarrierSink& sink) {
  if (auto r = check(config); !r) return r.error();
  auto carrier = std::make_unique<CarrierProcess>(std::move(config), sink);
  if (auto r = carrier->wait_for_first(); !r) return r.error();
  return std::unique_ptr<Carrier>{std::move(carrier)};
}

}  // namespace skein::network
