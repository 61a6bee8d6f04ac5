// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/can_flight_controller.hpp"

#include <poll.h>

#include <ctime>

#include "skein/wording/wording.hpp"

namespace skein::onboard {
namespace {

constexpr Duration kFactsPeriod = std::chrono::milliseconds{500};

}  // namespace

std::optional<VehicleState> CanFlightController::state(Instant now) {
  if (const auto* newer = sample_.read()) newest_ = *newer;
  if (!newest_) return std::nullopt;
  return ardupilot::carried_to(*newest_, now);
}

void CanFlightController::command(const Demand& demand, Instant now) {
  command_.write({demand, now});
}

void CanFlightController::give_back(Instant issued) {
  given_back_.store(issued.time_since_epoch().count(), std::memory_order_release);
}

void CanFlightController::keep_fence(const Fence& fence) {
  const std::lock_guard lock{fence_mutex_};
  fence_ = fence;
}

void CanFlightController::take_fence() {
  const std::unique_lock lock{fence_mutex_, std::try_to_lock};
  if (!lock.owns_lock() || !fence_) return;  // in the next period
  link_.companion().keep_fence(*fence_);
  fence_.reset();
}

std::string CanFlightController::mode() {
  if (const auto* newer = mode_.read()) newest_mode_ = *newer;
  return newest_mode_.text.data();
}

void CanFlightController::tell_mode() {
  const ardupilot::Companion& companion = link_.companion();
  std::string text = companion.mode();
  if (companion.state() != ardupilot::Companion::State::flying) {
    (text += text.empty() ? "" : ", ") += to_string(companion.state());
  }
  Mode mode;
  text.copy(mode.text.data(), mode.text.size() - 1);
  if (mode == told_mode_) return;
  told_mode_ = mode;
  mode_.write(mode);
}

void CanFlightController::tell_troubles() {
  const auto& newest = link_.companion().troubles();
  if (newest == troubles_) return;  // nobody else writes it
  const std::lock_guard lock{troubles_mutex_};
  troubles_ = newest;
}

std::vector<std::string> CanFlightController::problems() const {
  const std::lock_guard lock{troubles_mutex_};
  std::vector<std::string> all;
  all.reserve(troubles_.size());
  for (const AutopilotNotice& trouble : troubles_) all.push_back(wording::text_of(trouble));
  return all;
}

void CanFlightController::tell_facts(Instant now) {
  if (now < facts_at_) return;
  const std::unique_lock lock{facts_mutex_, std::try_to_lock};
  if (!lock.owns_lock()) return;  // in the next period
  facts_ = link_.facts(now);
  facts_at_ = now + kFactsPeriod;
}

std::optional<ardupilot::AutopilotFacts> CanFlightController::facts() const {
  const std::lock_guard lock{facts_mutex_};
  return facts_;
}

void CanFlightController::step(Instant now) {
  if (const auto* newer = command_.read()) {
    link_.companion().command(newer->demand, newer->at);
  }
  const Instant::rep issued = given_back_.exchange(kNothing, std::memory_order_acq_rel);
  if (issued != kNothing) (void)link_.companion().give_back(now, Instant{Duration{issued}});
  take_fence();
  link_.step(now);
  if (const auto sample = link_.companion().sample()) sample_.write(*sample);
  while (auto notice = link_.companion().poll_notice()) notices_.push(std::move(*notice));
  tell_mode();
  tell_troubles();
  tell_facts(now);
  const auto in_use = link_.companion().in_use();
  airborne_.store(!in_use   ? hal::Airborne::unknown
                  : *in_use ? hal::Airborne::yes
                            : hal::Airborne::no,
                  std::memory_order_relaxed);
}

void CanFlightController::wait(Duration at_most) const {
  // What the kernel had no room for is offered to it again soon.
  const Duration most =
      link_.bus().pending() > 0 ? Duration{std::chrono::milliseconds{1}} : at_most;
  const timespec timeout{.tv_sec = 0, .tv_nsec = static_cast<long>(most.count())};
  pollfd item{link_.bus().descriptor(), POLLIN, 0};
  (void)::ppoll(&item, 1, &timeout, nullptr);
}

}  // namespace skein::onboard
