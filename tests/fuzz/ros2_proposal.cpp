// SPDX-License-Identifier: Apache-2.0
//
// Any sample on ROS 2's topic of proposals. What is passed on is a marker that the ground station
// can read, of the proposal's own kind.
#include <span>

#include "fuzz_input.hpp"
#include "skein/agencies/marker_intake.hpp"
#include "skein/ros2/cdr.hpp"
#include "skein/ros2/proposals.hpp"

namespace skein::fuzz {
namespace {

void run(std::span<const std::uint8_t> sample) {
  ros2::ProposalIntake intake{"fuzz"};
  const auto marker = intake.take(sample, {}, 1'700'000'000'000'000'000);
  SKEIN_ASSERT(marker.has_value() == (intake.unreadable() == 0));
  if (!marker) return;
  const auto proposal = ros2::from_cdr<ros2::skein_msgs::SiteProposal>(sample);
  SKEIN_ASSERT(proposal);
  const auto origin =
      MissionOrigin::make({proposal->latitude, proposal->longitude, 0.0});  // so that it is near
  SKEIN_ASSERT(origin);
  const auto read = agencies::read_marker(*marker, *origin);
  SKEIN_ASSERT(read && *read);
  SKEIN_ASSERT((*read)->uid == "ros2-fuzz-1");
  SKEIN_ASSERT((*read)->detection.kind == static_cast<mission::IncidentKind>(proposal->kind));
}

}  // namespace
}  // namespace skein::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  skein::fuzz::run({data, size});
  return 0;
}
