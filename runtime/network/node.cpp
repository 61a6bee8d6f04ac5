// SPDX-License-Identifier: Apache-2.0
#include "skein/network/node.hpp"

#include <array>
#include <atomic>
#include <mutex>
#include <set>
#include <span>
#include <tuple>
#include <utility>

#include "carrier.hpp"
#include "signatures.hpp"
#include "skein/base/assert.hpp"
#include "skein/base/bounded_queue.hpp"
#include "skein/codec/codec.hpp"
#include "skein/mission/may_say.hpp"
#include "skein/mission/newest_station.hpp"

namespace skein::network {
namespace {

using codec::Topic;

constexpr std::size_t kMisfitsMax = 100;

enum class Counter : std::uint8_t {
  published,
  publish_refused_value,
  publish_refused_role,
  publish_failed,
  publish_unconnected,
  received,
  dropped_full,
  malformed,
  bad_version,
  bad_value,
  unknown_kind,
  unheeded,
  signature_missing,
  signature_forged,
  signature_replayed,
  key_news_forged,
  station_superseded,
  count
};
constexpr std::array<const char*, static_cast<std::size_t>(Counter::count)> kCounterNames{
    "published",
    "publish_refused_value",
    "publish_refused_role",
    "publish_failed",
    "publish_unconnected",
    "received",
    "dropped_full",
    "malformed",
    "bad_version",
    "bad_value",
    "unknown_kind",
    "unheeded",
    "signature_missing",
    "signature_forged",
    "signature_replayed",
    "key_news_forged",
    "station_superseded"};

}  // namespace

/// What judges: messages, signatures, who has said them. What carries their bytes is below it, and
/// may be a process of its own.
class Node::Impl : private CarrierSink {
 public:
  explicit Impl(const NodeConfig& config) : config_{config}, queue_{config.queue_limit} {
    if (config.seal) epoch_ = config.seal->key.epoch;
    if (config.sign) {
      signatures_ = std::make_unique<Signatures>(*config.sign, config.self, config.instance);
    }
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  virtual ~Impl() = default;

  Result<void> open();
  bool publish(const mission::Message& message);
  std::optional<Received> poll();
  std::vector<Misfit> take_misfits();
  std::map<std::string, std::uint64_t> counters() const;
  void change_key(const seal::EpochKey& key, Duration old_for);
  [[nodiscard]] std::optional<std::uint8_t> epoch() const {
    return config_.seal ? std::optional{epoch_.load()} : std::nullopt;
  }
  void learn(const identity::RevocationList& revoked) {
    if (signatures_) signatures_->learn(revoked);
    const std::lock_guard lock{queue_mutex_};
    station_ = {};  // it may have been who is out
  }
  void count_forged_key_news() { count(Counter::key_news_forged); }
  [[nodiscard]] bool seals() const { return config_.seal.has_value(); }
  [[nodiscard]] Carrier& carrier() { return *carrier_; }

 private:
  void on_sample(Topic topic, VehicleId sender, InstanceId instance,
                 std::span<const std::uint8_t> bytes) override;
  void on_certificate(std::span<const std::uint8_t> certificate) override {
    if (signatures_) signatures_->learn(certificate);
  }
  void refuse(Topic topic, const codec::Refusal& refusal, VehicleId sender);
  void refuse(Signatures::Judged judged);
  [[nodiscard]] bool heeds_station(const mission::Message& message, InstanceId instance);
  void count(Counter counter) {
    counters_.at(static_cast<std::size_t>(counter)).fetch_add(1, std::memory_order_relaxed);
  }

  const NodeConfig config_;
  std::atomic<std::uint8_t> epoch_{0};      ///< of one that seals
  std::unique_ptr<Signatures> signatures_;  ///< none: decisions are not signed
  std::array<std::atomic<std::uint64_t>, kCounterNames.size()> counters_{};
  mutable std::mutex queue_mutex_;
  BoundedQueue<Received> queue_;
  mission::NewestStation station_;  ///< under the same mutex
  std::mutex misfits_mutex_;
  std::set<std::tuple<VehicleId, Topic, std::uint16_t>> misfits_seen_;
  std::vector<Misfit> misfits_;
  std::unique_ptr<Carrier> carrier_;  ///< last: its threads use all of the above
};

Result<void> Node::Impl::open() {
  const auto open = config_.air        ? &open_air_carrier
                    : config_.isolated ? &open_carrier_process
                                       : &open_dds_carrier;
  auto opened = open(carrier_config(config_), *this);
  if (!opened) return opened.error();
  carrier_ = std::move(opened).value();
  return {};
}

bool Node::Impl::publish(const mission::Message& message) {
  const Topic topic = codec::topic_of(message);
  if (!codec::info(topic).writers.has(config_.role)) {
    count(Counter::publish_refused_role);
    return false;
  }
  auto bytes = codec::encode(message);
  if (!bytes) {
    count(Counter::publish_refused_value);
    return false;
  }
  if (signatures_ && mission::is_signed(message)) signatures_->sign(topic, *bytes);
  const Written written = carrier_->write(topic, std::move(*bytes));
  count(written == Written::yes       ? Counter::published
        : written == Written::no_room ? Counter::publish_failed
                                      : Counter::publish_unconnected);
  return written == Written::yes;
}

std::optional<Received> Node::Impl::poll() {
  const std::lock_guard lock{queue_mutex_};
  return queue_.pop();
}

void Node::Impl::on_sample(Topic topic, VehicleId sender, InstanceId instance,
                           std::span<const std::uint8_t> bytes) {
  std::span<const std::uint8_t> body{bytes};
  const auto signature = signatures_ ? cut_signature(body) : std::nullopt;
  auto decoded = codec::decode(topic, body);
  if (const auto* refusal = std::get_if<codec::Refusal>(&decoded)) {
    return refuse(topic, *refusal, sender);
  }
  auto& message = *std::get_if<mission::Message>(&decoded);
  if (config_.heeds && !config_.heeds(message)) return count(Counter::unheeded);
  if (signatures_ && mission::is_signed(message)) {
    auto judged = signatures_->judge(topic, sender, instance, body, signature);
    if (judged == Signatures::Judged::good) judged = signatures_->judge_approval(message);
    if (judged != Signatures::Judged::good) return refuse(judged);
  }
  bool room = false;
  bool is_heeded = true;
  {
    const std::lock_guard lock{queue_mutex_};
    if (sender == kGroundStation) is_heeded = heeds_station(message, instance);
    if (is_heeded) room = queue_.push(Received{std::move(message), sender, instance});
  }
  if (!is_heeded) return count(Counter::station_superseded);
  count(room ? Counter::received : Counter::dropped_full);
  if (room && config_.on_received) config_.on_received();
}

/// What nobody has proven supersedes none: the seal looks after who repeats an older start's.
bool Node::Impl::heeds_station(const mission::Message& message, InstanceId instance) {
  const bool is_proven = !signatures_ || mission::is_signed(message);
  if (is_proven) return station_.heeds(instance);
  return !station_.newest() || *station_.newest() <= instance;
}

void Node::Impl::refuse(Signatures::Judged judged) {
  switch (judged) {
    case Signatures::Judged::missing:
      return count(Counter::signature_missing);
    case Signatures::Judged::forged:
      return count(Counter::signature_forged);
    case Signatures::Judged::replayed:
      return count(Counter::signature_replayed);
    case Signatures::Judged::good:
    case Signatures::Judged::count:
      return;
  }
}

void Node::Impl::refuse(Topic topic, const codec::Refusal& refusal, VehicleId sender) {
  switch (refusal.fault) {
    case codec::Fault::malformed:
      return count(Counter::malformed);
    case codec::Fault::bad_value:
      return count(Counter::bad_value);
    case codec::Fault::unknown_kind:
      return count(Counter::unknown_kind);
    case codec::Fault::bad_version:
      break;
  }
  count(Counter::bad_version);
  const std::lock_guard lock{misfits_mutex_};
  if (misfits_seen_.size() >= kMisfitsMax) return;  // or a stranger fills the memory
  if (!misfits_seen_.emplace(sender, topic, refusal.version).second) return;
  misfits_.push_back({sender, codec::text_of(refusal, topic)});
}

std::vector<Misfit> Node::Impl::take_misfits() {
  const std::lock_guard lock{misfits_mutex_};
  return std::exchange(misfits_, {});
}

void Node::Impl::change_key(const seal::EpochKey& key, Duration old_for) {
  SKEIN_ASSERT(seals());
  epoch_ = key.epoch;
  carrier_->change_key(key, old_for);
}

std::map<std::string, std::uint64_t> Node::Impl::counters() const {
  std::map<std::string, std::uint64_t> all;
  for (std::size_t i = 0; i < counters_.size(); ++i) {
    all.emplace(kCounterNames.at(i), counters_.at(i).load(std::memory_order_relaxed));
  }
  const CarrierCounts carried = carrier_->counts();
  const auto of = [&carried](CarrierCount count, std::size_t offset = 0) {
    return carried.at(static_cast<std::size_t>(count) + offset);
  };
  all.emplace("unknown_sender", of(CarrierCount::unknown_sender));
  if (config_.air) {
    all.emplace("air_passed_on", of(CarrierCount::air_passed_on));
    all.emplace("air_repairs", of(CarrierCount::air_repairs));
    all.emplace("air_gave_way", of(CarrierCount::air_gave_way));
    all.emplace("air_lost", of(CarrierCount::air_lost));
  }
  if (config_.isolated) {
    all.emplace("carrier_lost", of(CarrierCount::lost));
    all.emplace("carrier_restarts", carrier_->restarts());
  }
  if (seals()) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(seal::Opened::count); ++i) {
      all.emplace(std::string{"seal_"} + seal::to_text(static_cast<seal::Opened>(i)),
                  of(CarrierCount::opened, i));
    }
    all.emplace("seal_misformed", of(CarrierCount::misformed));
  }
  return all;
}

Node::Node(std::unique_ptr<Impl> impl) : impl_{std::move(impl)} {}
Node::~Node() = default;

Result<std::unique_ptr<Node>> Node::open(const NodeConfig& config) {
  auto impl = std::make_unique<Impl>(config);
  if (auto r = impl->open(); !r) return r.error();
  return std::unique_ptr<Node>{new Node{std::move(impl)}};
}

bool Node::publish(const mission::Message& message) { return impl_->publish(message); }
std::optional<Received> Node::poll() { return impl_->poll(); }
std::vector<Peer> Node::peers() const { return impl_->carrier().peers(); }
std::vector<Reception> Node::receptions() const { return impl_->carrier().receptions(); }
void Node::change_key(const seal::EpochKey& key, Duration old_for) {
  impl_->change_key(key, old_for);
}
void Node::learn(const identity::RevocationList& revoked) { impl_->learn(revoked); }
std::optional<std::uint8_t> Node::epoch() const { return impl_->epoch(); }
void Node::tell(const std::vector<KeyNews>& news) {
  if (impl_->seals()) impl_->carrier().tell(news);
}
std::optional<std::vector<std::uint8_t>> Node::take_key_news() {
  return impl_->seals() ? impl_->carrier().take_key_news() : std::nullopt;
}
void Node::count_forged_key_news() { impl_->count_forged_key_news(); }
std::vector<Misfit> Node::take_misfits() { return impl_->take_misfits(); }
std::vector<std::string> Node::take_troubles() { return impl_->carrier().take_troubles(); }
std::map<std::string, std::uint64_t> Node::counters() const { return impl_->counters(); }

}  // namespace skein::network
