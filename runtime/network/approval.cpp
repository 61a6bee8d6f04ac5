// SPDX-License-Identifier: Apache-2.0
#include "skein/network/approval.hpp"

#include <algorithm>
#include <span>

#include "skein/codec/codec.hpp"

namespace skein::network {

std::optional<identity::Approval> approval_of(const mission::Authorisation& authorisation) {
  if (!authorisation.granted || authorisation.deliveries.empty()) return std::nullopt;
  mission::Authorisation plan = authorisation;
  plan.round = {};
  plan.approval.clear();
  const auto bytes = codec::encode(mission::Message{plan});
  if (!bytes) return std::nullopt;
  identity::Approval approval;
  approval.plan = identity::digest(*bytes);
  for (const auto& delivery : plan.deliveries) {
    approval.vehicles.push_back(delivery.assignment.vehicle);
  }
  std::ranges::sort(approval.vehicles);
  approval.vehicles.erase(std::unique(approval.vehicles.begin(), approval.vehicles.end()),
                          approval.vehicles.end());
  approval.from = plan.decided_at;
  approval.until = plan.until;
  approval.granted = true;
  return approval;
}

Result<void> approve(mission::Authorisation& authorisation, const identity::Signer& op,
                     const identity::Certificate& certificate) {
  const auto approval = approval_of(authorisation);
  if (!approval) return Error{"there is no delivery to approve"};
  authorisation.approval = identity::to_bytes(certificate);
  const auto signature = op.sign(*approval);
  authorisation.approval.insert(authorisation.approval.end(), signature.begin(), signature.end());
  return {};
}

std::optional<CarriedApproval> carried_approval(const mission::Authorisation& authorisation) {
  CarriedApproval carried;
  const std::span<const std::uint8_t> bytes{authorisation.approval};
  if (bytes.size() <= carried.signature.size()) return std::nullopt;
  auto by = identity::certificate_from(bytes.first(bytes.size() - carried.signature.size()));
  if (!by || by->role != identity::Role::op) return std::nullopt;
  carried.by = *std::move(by);
  std::ranges::copy(bytes.last(carried.signature.size()), carried.signature.begin());
  return carried;
}

}  // namespace skein::network
