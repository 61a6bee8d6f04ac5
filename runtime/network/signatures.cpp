// SPDX-License-Identifier: Apache-2.0
#include "signatures.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>

#include "skein/network/approval.hpp"

namespace skein::network {
namespace {

constexpr std::array<std::uint8_t, 4> kMark{'S', 'k', 'S', 1};  // the last is the version
constexpr std::size_t kSignatureAt = 16;
/// What was signed longer before a node's start is not for it: nothing of value is said again so
/// late.
constexpr std::chrono::seconds kBeforeStart{60};

std::chrono::nanoseconds since_1970() {
  return std::chrono::system_clock::now().time_since_epoch();
}

void put(std::vector<std::uint8_t>& bytes, std::uint64_t number) {
  for (unsigned i = 0; i < 8; ++i) {
    bytes.push_back(static_cast<std::uint8_t>((number >> (8U * i)) & 0xFFU));
  }
}

std::uint64_t number_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::uint64_t number = 0;
  for (unsigned i = 0; i < 8; ++i) number |= std::uint64_t{bytes[at + i]} << (8U * i);
  return number;
}

identity::Statement statement_of(codec::Topic topic, VehicleId sender, InstanceId instance,
                                 std::uint64_t sequence, std::int64_t time_ns,
                                 std::span<const std::uint8_t> body) {
  return {codec::kTopics.at(static_cast<std::size_t>(topic)).name,
          sender,
          instance,
          sequence,
          Instant{Duration{time_ns}},
          body};
}

}  // namespace

std::optional<std::span<const std::uint8_t>> cut_signature(std::span<const std::uint8_t>& bytes) {
  if (bytes.size() < kSignatureBytes) return std::nullopt;
  const auto behind = bytes.last(kSignatureBytes);
  if (!std::ranges::equal(behind.last(kMark.size()), kMark)) return std::nullopt;
  bytes = bytes.first(bytes.size() - kSignatureBytes);
  return behind;
}

Signatures::Signatures(SignConfig config, VehicleId self, InstanceId instance)
    : config_{std::move(config)}, self_{self}, instance_{instance}, verifier_{config_.verifier} {}

void Signatures::learn(std::span<const std::uint8_t> certificate) {
  const auto read = identity::certificate_from(certificate);
  if (!read || read->role == identity::Role::op) return;
  const Unverified heard{*read, std::chrono::duration_cast<std::chrono::seconds>(since_1970())};
  const std::lock_guard lock{mutex_};
  // Whichever ground station has the command speaks as the one.
  const VehicleId speaks_as = read->role == identity::Role::ground ? kGroundStation : read->node;
  const auto [from, to] = unverified_.equal_range(speaks_as);
  if (std::any_of(from, to, [&](const auto& one) { return one.second.certificate == *read; })) {
    return;
  }
  const bool full = unverified_.size() >= kUnverifiedMax;
  if (full || static_cast<std::size_t>(std::distance(from, to)) >= kUnverifiedOfNode) {
    return verify(heard);
  }
  unverified_.emplace(speaks_as, heard);
}

void Signatures::verify_certificates(VehicleId of) {
  const auto [from, to] = unverified_.equal_range(of);
  for (auto one = from; one != to; ++one) verify(one->second);
  unverified_.erase(from, to);
}

void Signatures::verify(const Unverified& unverified) {
  const identity::Certificate& certificate = unverified.certificate;
  if (verifier_.learn(certificate, unverified.heard_at.count()) != identity::Trust::good) return;
  const auto [serial, is_new] = serials_.try_emplace(certificate.node, certificate.serial);
  if (is_new || !(serial->second < certificate.serial)) return;
  // Who has the keys of before may have used up the numbers; nothing signed with them is good now.
  serial->second = certificate.serial;
  std::erase_if(newest_,
                [&](const auto& newest) { return newest.first.first == certificate.node; });
}

void Signatures::learn(const identity::RevocationList& list) {
  const std::lock_guard lock{mutex_};
  (void)verifier_.learn(list);
  // A ground station that is out may have used up the numbers of all.
  if (!verifier_.knows_stations()) return;
  std::erase_if(newest_, [](const auto& newest) { return newest.first.first == kGroundStation; });
}

void Signatures::sign(codec::Topic topic, std::vector<std::uint8_t>& bytes) {
  const std::int64_t time_ns = since_1970().count();
  std::uint64_t sequence = 0;
  {
    const std::lock_guard lock{mutex_};
    sequence = ++said_.at(static_cast<std::size_t>(topic));
  }
  const auto signature =
      config_.signer.sign(statement_of(topic, self_, instance_, sequence, time_ns, bytes));
  put(bytes, sequence);
  put(bytes, static_cast<std::uint64_t>(time_ns));
  bytes.insert(bytes.end(), signature.begin(), signature.end());
  bytes.insert(bytes.end(), kMark.begin(), kMark.end());
}

Signatures::Judged Signatures::judge(codec::Topic topic, VehicleId sender, InstanceId instance,
                                     std::span<const std::uint8_t> body,
                                     std::optional<std::span<const std::uint8_t>> signature) {
  if (!signature) return Judged::missing;
  const std::uint64_t sequence = number_at(*signature, 0);
  const auto time_ns = static_cast<std::int64_t>(number_at(*signature, 8));
  identity::Signature of{};
  std::ranges::copy(signature->subspan(kSignatureAt, of.size()), of.begin());
  // By this host's clock of now: it may have been set since the start.
  const auto start_ns = since_1970() - (std::chrono::steady_clock::now() - started_);
  if (topic != codec::Topic::setup && time_ns < (start_ns - kBeforeStart).count()) {
    return Judged::replayed;
  }
  const std::lock_guard lock{mutex_};
  verify_certificates(sender);
  const auto known = newest_.find({sender, topic});
  if (known != newest_.end() &&
      std::pair{instance, sequence} <= std::pair{known->second.instance, known->second.sequence}) {
    return Judged::replayed;
  }
  const auto statement = statement_of(topic, sender, instance, sequence, time_ns, body);
  if (verifier_.verify(statement, of) != identity::Trust::good) return Judged::forged;
  newest_[{sender, topic}] = {instance, sequence};
  return Judged::good;
}

Signatures::Judged Signatures::judge_approval(const mission::Message& message) {
  const auto* grant = std::get_if<mission::Authorisation>(&message);
  if (grant == nullptr || !grant->granted) return Judged::good;
  const auto approval = approval_of(*grant);
  const auto carried = carried_approval(*grant);
  if (!approval || !carried) return Judged::missing;
  const auto now = std::chrono::duration_cast<std::chrono::seconds>(since_1970());
  const std::lock_guard lock{mutex_};
  const bool is_good =
      verifier_.learn(carried->by, now.count()) == identity::Trust::good &&
      verifier_.verify(carried->by.name, *approval, carried->signature) == identity::Trust::good;
  return is_good ? Judged::good : Judged::forged;
}

}  // namespace skein::network
