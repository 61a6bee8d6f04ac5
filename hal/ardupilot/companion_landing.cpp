// SPDX-License-Identifier: Apache-2.0
#include <type_traits>
#include <utility>

#include "companion_impl.hpp"

/// What the autopilot is given to keep: its fence, and the mission by which a plane is landed.
namespace skein::ardupilot {
namespace {

constexpr Duration kUploadAgain = std::chrono::seconds{10};

}  // namespace

FlightPhase Companion::Impl::phase() const {
  if (landed_state() == mavlink::LandedState::undefined) return FlightPhase::not_told;
  // A quadplane that has landed and disarmed tells for seconds that it is in the air.
  if (!armed_) return FlightPhase::disarmed;
  if (!airborne()) return FlightPhase::landed;
  const bool is_lost =
      machine_.in(State::lost) || machine_.in(State::silent) || machine_.in(State::checking);
  const State state = is_lost ? before_loss_ : machine_.state();
  return state == State::landing ? FlightPhase::landing : FlightPhase::flying;
}

void Companion::Impl::forget_landing() {
  upload_.clear();
  uploads_.reset();
  may_land_ = false;
  told_upload_ = false;
}

void Companion::Impl::not_landed(std::string why, Instant now) {
  forget_landing();
  upload_again_at_ = now + kUploadAgain;
  say(true, {.news = AutopilotNews::landing_not_uploaded, .detail = std::move(why)}, now);
}

/// The mission goes to the autopilot and back, is begun at its landing, and flown.
void Companion::Impl::prepare_landing(const Landing& landing, Instant now) {
  if (uploads_ != landing) {
    if (now < upload_again_at_) return;
    forget_landing();
    uploads_ = landing;
    upload_.begin(landing_mission(landing, *traits_.touch_down, origin_), now);
  }
  if (upload_.state() == MissionUpload::State::failed) return not_landed(upload_.why(), now);
  if (upload_.state() != MissionUpload::State::verified) return;
  if (!std::exchange(told_upload_, true)) {
    say(false, {.news = AutopilotNews::landing_uploaded, .detail = "4 items"}, now);
    ask(command_of(mavlink::Command::do_set_mission_current, kLandFromItem), {}, true);
  }
  if (may_land_) fire(Event::may_land, now);
}

void Companion::Impl::land(Instant now) {
  const auto* setpoint = demand_ ? std::get_if<Setpoint>(&*demand_) : nullptr;
  const bool fresh = now - demand_at_ <= params_.setpoint_age_max;
  const bool called_off = traits_.touch_down && setpoint != nullptr && fresh && !setpoint->landing;
  if (called_off && airborne() && motion_.relative_height_m() >= kGoAroundFrom_m) {
    say(false, {.news = AutopilotNews::going_around}, now);
    return fire(Event::called_off, now);
  }
  if (called_off && airborne() && !std::exchange(told_too_low_, true)) {
    say(true,
        {.news = AutopilotNews::no_go_around,
         .number = static_cast<std::uint16_t>(kGoAroundFrom_m)},
        now);
  }
  if (!entry_.mode_confirmed) ask_for_mode(traits_.land_mode, now);
}

void Companion::Impl::keep_fence(const Fence& fence) {
  params_.fence = fence;
  forget_fence();
  renews_fence_ = true;
  parameters_.add(ordered_fence_questions());
}

/// Until it has it, and has told how it is set: what is wrong is told, and flown on with.
void Companion::Impl::renew_fence(Instant now) {
  for (const std::string_view name : parameters_.due(now)) ask_parameter(name);
  renews_fence_ = !give_fence(now) || !parameters_.all_tried();
}

void Companion::Impl::forget_fence() {
  fence_upload_.clear();
  fence_again_at_ = Instant::min();
  fence_failed_.clear();
  told_fence_ = false;
}

bool Companion::Impl::give_fence(Instant now) {
  if (!params_.fence.exists()) return true;
  switch (fence_upload_.state()) {
    case MissionUpload::State::verified:
      if (!std::exchange(told_fence_, true)) {
        fence_failed_.clear();
        const auto corners = static_cast<std::uint16_t>(params_.fence.corners.size());
        say(false, {.news = AutopilotNews::fence_uploaded, .number = corners}, now);
      }
      return true;
    case MissionUpload::State::failed:
      fence_failed_ = fence_upload_.why();
      fence_again_at_ = now + kUploadAgain;
      fence_upload_.clear();
      break;
    case MissionUpload::State::idle:
      if (desk_.idle() && now >= fence_again_at_) {
        fence_upload_.begin(fence_mission(params_.fence, origin_), now);
      }
      break;
    case MissionUpload::State::sending:
    case MissionUpload::State::reading:
      break;
  }
  return false;
}

void Companion::Impl::say_upload(MissionUpload& upload, Instant now) {
  upload.step(now);
  while (auto message = upload.poll()) {
    std::visit(
        [this](auto& said) {
          said.target_system = system_;
          said.target_component = mavlink::kComponentAutopilot;
          send(said);
        },
        *message);
  }
}

}  // namespace skein::ardupilot
