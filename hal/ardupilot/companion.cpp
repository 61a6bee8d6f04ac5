// SPDX-License-Identifier: Apache-2.0
#include "skein/ardupilot/companion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "companion_impl.hpp"
#include "skein/ardupilot/flight_limits.hpp"
#include "skein/domain/set_down.hpp"
#include "steering.hpp"

namespace skein::ardupilot {
namespace {

using mavlink::Command;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kHeartbeatPeriod = seconds{1};
constexpr Duration kTargetPeriod = milliseconds{40};  ///< of attitude and velocity targets
constexpr int kRetries = 5;
constexpr int kArmRetries = 60;  ///< a filter that has no position yet takes most of a minute
constexpr Duration kLaunchWithin = seconds{60};  ///< a plane may wait for the hand that throws it
constexpr double kClimbMin_mps = 1.0;
constexpr Duration kAskAgain = seconds{2};  ///< for streams that do not come
constexpr Duration kSilenceUnstreamed = seconds{3};
constexpr Duration kStreamsForgotten = milliseconds{500};  ///< perhaps, after such a loss
constexpr Duration kClockSoon = milliseconds{200};
constexpr Duration kClockPeriod = seconds{1};
constexpr int kClockQuestionsSoon = 8;
constexpr std::size_t kClockAskedMax = 16;
constexpr Duration kDuplicateGone = seconds{2};
constexpr double kSinks_mps = 0.2;                   ///< a point that does so faster comes down
constexpr double kBendLeast_m = 2.0;                 ///< of a point that begins to sink lower
constexpr Duration kStillSinks = milliseconds{500};  ///< while it slows down
constexpr double kGround_m = 0.05;  ///< a setpoint no higher above home is on the ground
constexpr Duration kSampleAgeMax = milliseconds{500};
constexpr double kSpeedStep_mps = 0.2;
constexpr Duration kSpeedPeriod = milliseconds{500};
constexpr double kHeightStep_m = 0.5;
/// Of the least airspeed: a quadplane that is slower, and does not tell, is on its rotors.
constexpr double kHoverShare = 0.7;
constexpr Duration kLeaveAgain = seconds{10};  ///< its wings take that long
constexpr double kLifted_m = 2.0;              ///< what hovers there is in the air
constexpr double kHeartbeat_hz = 20.0;         ///< it tells of the pilot's switch
constexpr double kHud_hz = 10.0;
constexpr double kHealth_hz = 2.0;
constexpr double kLook_hz = 1.0;

/// As MAVLink carries it, and still within the limits: an autopilot refuses a speed beyond its own.
double speed_within(double speed_mps, const VehicleSpec& vehicle) {
  const double clamped = std::clamp(speed_mps, vehicle.speed_min_mps, vehicle.speed_max_mps);
  const auto carried = static_cast<float>(clamped);
  if (carried > vehicle.speed_max_mps) return std::nextafter(carried, 0.0F);
  if (carried < vehicle.speed_min_mps) return std::nextafter(carried, 1e3F);
  return carried;
}

}  // namespace

// --- what the operator asks ----------------------------------------------------------------------

bool Companion::Impl::give_back(Instant now, Instant issued) {
  const bool in_flight = armed_ && airborne();
  const bool from_ground = params_.take_over == TakeOver::from_ground;
  const bool waits_landed =
      !armed_ && !airborne() && (custody_.by_others() || (from_ground && !custody_.may_launch()));
  AutopilotNotice refusal{AutopilotNews::not_given_back};
  if (machine_.in(State::duplicated)) {
    if (duplicate_at_ && now - *duplicate_at_ < kDuplicateGone) {
      refusal.refusal = GiveBackRefusal::node_still_duplicate;
      refusal.number = duplicate_node_;
    }
  } else if (!machine_.accepts(Event::given_back)) {
    refusal.refusal = GiveBackRefusal::wrong_state;
    refusal.detail = to_string(machine_.state());
  } else if (custody_.by_others() && issued < taken_at_) {
    refusal.refusal = GiveBackRefusal::taken_since;
  } else if (!navigation_healthy()) {
    refusal.refusal = GiveBackRefusal::no_position;
  } else if (!in_flight && !waits_landed) {
    refusal.refusal = GiveBackRefusal::not_flying;
  } else if (in_flight && hovers_low()) {
    refusal.refusal = GiveBackRefusal::hovers_low;
    refusal.number = taken_over_at();
  }
  if (refusal.refusal != GiveBackRefusal::none) {
    say(true, std::move(refusal), now);
    return false;
  }
  if (machine_.in(State::duplicated)) {
    fire(Event::given_back, now);
    return true;
  }
  if (in_flight) {
    custody_.fire(Custody::Event::given_back);
    fire(Event::given_back, now);
    return true;
  }
  custody_.fire(Custody::Event::given_back_landed);
  say(false, {AutopilotNews::given_back_landed}, now);
  if (machine_.in(State::piloted)) fire(Event::given_back_landed, now);
  return true;
}

// --- what is due ---------------------------------------------------------------------------------

void Companion::Impl::step(Instant now) {
  watch_silence(now);
  if (encoder_) mavlink::sign_at(params_.signing, *encoder_, parser_, now);
  while (const auto outcome = desk_.give_up(now)) on_outcome(*outcome, now);
  if (refusal_ && now - refusal_at_ > kReasonWithin) report_refusal(now);
  switch (machine_.state()) {
    case State::preparing:
      prepare(now);
      break;
    case State::standing_by:
      stand_by(now);
      break;
    case State::arming:
      arm(now);
      break;
    case State::climbing:
      if (high()) {
        fire(Event::climbed, now);
      } else if (now >= climb_by_) {
        fire(Event::not_obeyed, now);
      }
      break;
    case State::taking_over:
      ask_for_mode(traits_.guided_mode, now);
      break;
    case State::flying:
      fly(now);
      break;
    case State::landing:
      land(now);
      break;
    default:
      break;
  }
  watch_troubles(now);
  if (system_ == 0) return;
  check_parameters(now);
  ask_others(now);
  keep_clock(now);
  if (renews_fence_ && !machine_.in(State::preparing)) renew_fence(now);
  say_remote_id(now);
  say_upload(fence_upload_, now);
  say_upload(upload_, now);
  if (now >= heartbeat_at_) {
    heartbeat_at_ = std::max(heartbeat_at_ + kHeartbeatPeriod, now + kHeartbeatPeriod / 2);
    mavlink::Heartbeat heartbeat;
    heartbeat.type = static_cast<std::uint8_t>(mavlink::VehicleType::onboard_controller);
    heartbeat.autopilot = static_cast<std::uint8_t>(mavlink::Autopilot::invalid);
    heartbeat.system_status = static_cast<std::uint8_t>(mavlink::SystemState::active);
    send(heartbeat);
  }
  while (const auto command = desk_.next(now)) send_command(*command);
}

void Companion::Impl::watch_silence(Instant now) {
  if (machine_.in(State::preparing)) {
    if (now - packet_heard_ > kSilenceUnstreamed) fire(Event::link_lost, now);
    return;
  }
  const Duration silence =
      streams_granted_ ? params_.silence : std::max(params_.silence, kSilenceUnstreamed);
  if (now - packet_heard_ < silence) return;
  if (now - frame_heard_ >= silence) {
    if (machine_.accepts(Event::link_lost)) fire(Event::link_lost, now);
  } else if (machine_.accepts(Event::autopilot_silent) && !machine_.in(State::lost)) {
    fire(Event::autopilot_silent, now);
  }
}

void Companion::Impl::prepare(Instant now) {
  if (!streams_asked_at_ || (desk_.idle() && now - *streams_asked_at_ >= kAskAgain)) {
    streams_asked_at_ = now;
    ask_streams();
    if (firmware_ != Firmware::accepted) {
      ask(command_of(Command::request_message, mavlink::AutopilotVersion::kDefinition.id), {},
          false);
    }
  }
  for (const std::string_view name : parameters_.due(now)) ask_parameter(name);
  const bool clock_known = clock_.synchronised() || now - *streams_asked_at_ >= kAskAgain / 2;
  const bool is_known = desk_.idle() && clock_known && looked_at_.health && motion_.sample();
  const bool fenced = give_fence(now);
  if (is_known && fenced && parameters_.good()) fire(Event::ready, now);
}

std::vector<ParameterQuestion> Companion::Impl::questions_of(const CompanionParams& params) {
  auto questions = safety_questions(params.vehicle, params.system_id, params.fence);
  for (ParameterQuestion& one : remote_id_questions(params.remote_id)) {
    questions.push_back(std::move(one));
  }
  for (ParameterQuestion& limit : limit_questions(params.vehicle)) {
    questions.push_back(std::move(limit));
  }
  return questions;
}

void Companion::Impl::check_parameters(Instant now) {
  while (auto finding = parameters_.poll_finding(now)) {
    say(true, {.news = parameter_news(), .detail = *std::move(finding)}, now);
  }
}

void Companion::Impl::ask_streams() {
  const auto stream = [this](std::uint32_t id, double hz) {
    ask(command_of(Command::set_message_interval, id, 1e6 / hz), {}, false);
  };
  stream(mavlink::Heartbeat::kDefinition.id, kHeartbeat_hz);
  stream(mavlink::Attitude::kDefinition.id, params_.stream_hz);
  stream(mavlink::GlobalPositionInt::kDefinition.id, params_.stream_hz);
  stream(mavlink::VfrHud::kDefinition.id, kHud_hz);
  stream(mavlink::SysStatus::kDefinition.id, kHealth_hz);
  stream(mavlink::ExtendedSysState::kDefinition.id, kHealth_hz);
  for (const std::uint32_t id : kOnlyLookedAt) stream(id, kLook_hz);
}

bool Companion::Impl::airborne() const {
  const auto landed = landed_state();
  if (landed != mavlink::LandedState::undefined) return landed != mavlink::LandedState::on_ground;
  const auto sample = motion_.sample();
  if (!sample) return false;
  if (traits_.is_lifted && motion_.relative_height_m() > kLifted_m) return true;
  return !traits_.flies_to_points &&
         sample->state.airspeed_mps > params_.vehicle.speed_min_mps / 2.0;
}

bool Companion::Impl::high() const {
  return motion_.relative_height_m() >= taken_over_at_m(params_.takeoff_height_m);
}

bool Companion::Impl::hovers() const {
  if (!traits_.hovers_first) return false;
  using mavlink::VtolState;
  const auto told = looked_at_.landed ? static_cast<VtolState>(looked_at_.landed->vtol_state)
                                      : VtolState::undefined;
  if (told != VtolState::undefined) {
    return told == VtolState::on_rotors || told == VtolState::to_rotors;
  }
  const auto sample = motion_.sample();
  return sample && sample->state.airspeed_mps < kHoverShare * params_.vehicle.speed_min_mps;
}

std::optional<bool> Companion::Impl::in_use() const {
  static constexpr std::array kDeaf{State::searching, State::refused,  State::lost,
                                    State::silent,    State::checking, State::duplicated};
  if (std::ranges::find(kDeaf, machine_.state()) != kDeaf.end()) return std::nullopt;
  return armed_ || airborne();
}

void Companion::Impl::stand_by(Instant now) {
  if (custody_.by_others() || !navigation_healthy()) return;
  const bool in_flight = armed_ && airborne();
  switch (params_.take_over) {
    case TakeOver::when_guided:
      if (in_flight && guided()) fire(Event::guided, now);
      break;
    case TakeOver::in_flight:
      if (in_flight && !hovers_low()) fire(guided() ? Event::guided : Event::may_take, now);
      break;
    case TakeOver::from_ground: {
      if (custody_.own_flight() && in_flight && high()) {
        fire(guided() ? Event::guided : Event::may_take, now);
      } else if (custody_.may_launch() && !armed_ && !airborne() && !lacks_remote_id(now)) {
        if (looked_at_.prearm_good()) {
          fire(Event::may_launch, now);
        } else {
          leave_return_on_ground(now);
        }
      }
      break;
    }
    case TakeOver::count:
      break;
  }
}

/// An autopilot that has waited for its companion may have begun to return home without having left
/// it. It is not fit to be armed until it is in another mode.
void Companion::Impl::leave_return_on_ground(Instant now) {
  if (!traits_.is_return(mode_) || now < entry_.retry_at) return;
  entry_.retry_at = now + kRetryPeriod;
  ask(command_of(Command::do_set_mode, 1, traits_.takeoff_mode), {1, kRetryPeriod}, true);
}

void Companion::Impl::arm(Instant now) {
  if (now < entry_.retry_at) return;
  if (entry_.retries++ >= kArmRetries) return fire(Event::not_obeyed, now);
  entry_.retry_at = now + kRetryPeriod;
  if (mode_ != traits_.takeoff_mode) {
    ask(command_of(Command::do_set_mode, 1, traits_.takeoff_mode), {1, kRetryPeriod}, true);
  } else {
    entry_.arm_asked = true;
    ask(command_of(Command::component_arm_disarm, 1), {1, kRetryPeriod}, true);
  }
}

void Companion::Impl::ask_for_mode(std::uint32_t mode, Instant now) {
  if (now < entry_.retry_at) return;
  if (entry_.retries++ >= kRetries) return fire(Event::not_obeyed, now);
  entry_.retry_at = now + kRetryPeriod;
  ask(command_of(Command::do_set_mode, 1, mode), {1, kRetryPeriod}, true);
}

template <class Message>
void Companion::Impl::send_target(Message target, Instant now) {
  if (now < target_at_) return;
  target_at_ = std::max(target_at_ + kTargetPeriod, now + kTargetPeriod / 2);
  target.time_boot_ms = static_cast<std::uint32_t>(
      std::chrono::duration_cast<milliseconds>(now.time_since_epoch()).count());
  target.target_system = system_;
  target.target_component = mavlink::kComponentAutopilot;
  send(target);
}

void Companion::Impl::fly(Instant now) {
  const auto sample = motion_.sample();
  const bool fresh = sample && now - sample->state.time <= kSampleAgeMax;
  if (fresh) leave_hover(now);
  if (!fresh || !demand_ || now - demand_at_ > params_.setpoint_age_max) {
    on_ground_since_.reset();
    return;
  }
  const VehicleState state = carried_to(*sample, now);
  if (const auto* point = std::get_if<PositionSetpoint>(&*demand_)) {
    const double home_z_m = sample->state.z_m - motion_.relative_height_m();
    fly_to(point->carried_on(to_seconds(now - demand_at_)), state, home_z_m, now);
    return;
  }
  const auto& setpoint = std::get<Setpoint>(*demand_);
  if (traits_.flies_to_points) {
    send_target(velocity_target(setpoint, state), now);
    return;
  }
  send_target(roll_target(bank_for(params_.vehicle, setpoint, state, sample->turn_ability)), now);
  set_speed(setpoint, sample->true_per_equivalent, now);
  set_height(setpoint, state, now);
  if (setpoint.landing) {
    prepare_landing(*setpoint.landing, now);
  } else if (uploads_) {
    forget_landing();
  }
}

void Companion::Impl::fly_to(PositionSetpoint point, const VehicleState& state, double home_z_m,
                             Instant now) {
  const double off_m = std::hypot(point.x_m - state.x_m, point.y_m - state.y_m);
  if (point.z_m > home_z_m + kGround_m || off_m > kLandWithin_m) {
    on_ground_since_.reset();
  } else if (!on_ground_since_) {
    on_ground_since_ = now;
  } else if (now - *on_ground_since_ >= kLandAfter) {
    return fire(Event::may_land, now);
  }
  Climb led{point.z_m - home_z_m, point.vz_mps, point.az_mps2};
  const bool sank = sank_at_ && now - *sank_at_ < kStillSinks;
  const bool sinks = point.vz_mps < -kSinks_mps;
  if (sinks && !sank) sinks_from_m_ = std::clamp(led.height_m, kBendLeast_m, kSlowedFrom_m);
  if (sinks || led.height_m <= kGround_m) sank_at_ = now;
  if (sank_at_ == now || (sank && point.vz_mps <= kSinks_mps)) {
    led = led_down(led, sinks_from_m_);
  } else if (led.height_m < kHoverFrom_m) {
    led = {.height_m = kHoverFrom_m};
  }
  point.z_m = home_z_m + led.height_m;
  point.vz_mps = led.rate_mps;
  point.az_mps2 = led.acceleration_mps2;
  send_target(point_target(point, origin_, params_.geoid_height_m), now);
}

void Companion::Impl::set_speed(const Setpoint& setpoint, double true_per_equivalent, Instant now) {
  const double wanted = speed_within(setpoint.airspeed_mps / true_per_equivalent, params_.vehicle);
  const bool differs = !speed_sent_ || std::abs(wanted - *speed_sent_) >= kSpeedStep_mps;
  if (!differs || (speed_sent_ && now - speed_at_ < kSpeedPeriod)) return;
  speed_sent_ = wanted;
  speed_at_ = now;
  ask(command_of(Command::do_change_speed, 0, wanted, -1), {1, Patience{}.each}, true);
}

void Companion::Impl::set_height(const Setpoint& setpoint, const VehicleState& state, Instant now) {
  const double seconds = flown_at_ ? to_seconds(now - *flown_at_) : 0.0;
  flown_at_ = now;
  const double height_m =
      setpoint.height_m + height_error_.step(setpoint.height_m - state.z_m, seconds);
  // The mission's plane is flat and the sea is not: by two metres at five kilometres.
  const double above_sea =
      origin_.to_wgs84({state.x_m, state.y_m, height_m}).height_m - params_.geoid_height_m;
  if (height_sent_ && std::abs(above_sea - *height_sent_) < kHeightStep_m) return;
  if (height_at_ && now - *height_at_ < kRetryPeriod) return;
  height_sent_ = above_sea;
  height_at_ = now;
  ask(command_of(Command::do_change_altitude, above_sea,
                 static_cast<double>(mavlink::Frame::global)),
      {}, true);
}

void Companion::Impl::keep_clock(Instant now) {
  if (now < clock_at_) return;
  clock_at_ = now + (clock_questions_ < kClockQuestionsSoon ? kClockSoon : kClockPeriod);
  ++clock_questions_;
  mavlink::Timesync question;
  question.ts1 = now.time_since_epoch().count();
  if (clock_asked_.size() == kClockAskedMax) clock_asked_.erase(clock_asked_.begin());
  clock_asked_.push_back(now);
  send(question);
}

void Companion::Impl::say_remote_id(Instant now) {
  if (const auto sample = motion_.sample()) {
    remote_id_.on_place(origin_.to_wgs84(sample->state.position()), armed_ || airborne());
  }
  remote_id_.speak(system_, now, [this](const auto& message) { send(message); });
}

void Companion::Impl::ask_parameter(std::string_view name) {
  send(mavlink::ParamRequestRead{.param_index = -1,
                                 .target_system = system_,
                                 .target_component = mavlink::kComponentAutopilot,
                                 .param_id = mavlink::field_of<16>(name)});
}

void Companion::Impl::ask(const mavlink::CommandLong& command, const Patience& patience,
                          bool latest) {
  mavlink::CommandLong addressed = command;
  addressed.target_system = system_;
  addressed.target_component = mavlink::kComponentAutopilot;
  desk_.ask(addressed, patience, latest);
}

/// ArduPlane takes a place as COMMAND_INT alone, and none of latitude and longitude 0: it is where
/// the aircraft is.
void Companion::Impl::send_command(const mavlink::CommandLong& command) {
  if (command.command != static_cast<std::uint16_t>(Command::do_reposition)) return send(command);
  mavlink::CommandInt place;
  place.target_system = command.target_system;
  place.target_component = command.target_component;
  if (const auto sample = motion_.sample()) {
    const Wgs84 here = origin_.to_wgs84(sample->state.position());
    place.x = static_cast<std::int32_t>(std::lround(here.latitude_deg * 1e7));
    place.y = static_cast<std::int32_t>(std::lround(here.longitude_deg * 1e7));
  }
  place.command = command.command;
  place.frame = static_cast<std::uint8_t>(mavlink::Frame::global_relative_alt);
  place.param1 = command.param1;
  place.param2 = command.param2;
  place.z = command.param7;
  send(place);
}

// --- changes of state ----------------------------------------------------------------------------

void Companion::Impl::fire(Event event, Instant now) {
  const State from = machine_.state();
  if (machine_.fire(event)) entered(from, event, now);
}

AutopilotNotice Companion::Impl::why_piloted(State from, Event event) const {
  if (event == Event::other_mode) {
    const bool armed = from == State::arming && armed_;
    return {.news = armed ? AutopilotNews::armed_by_others : AutopilotNews::mode_changed,
            .detail = mode()};
  }
  if (from != State::climbing) return {.news = AutopilotNews::not_obeying};
  return {.news = AutopilotNews::not_climbed,
          .number = static_cast<std::uint16_t>(std::lround(params_.takeoff_height_m))};
}

Given Companion::Impl::given() const {
  if (custody_.by_others()) return Given::taken_by_others;
  const bool spent = custody_.state() == Custody::State::spent;
  return params_.take_over == TakeOver::from_ground && spent ? Given::launch_spent : Given::yes;
}

void Companion::Impl::enter_standing_by(State from, Event event, Instant now) {
  if (from != State::checking) desk_.clear();  // there the streams were asked for
  if (from == State::preparing) {
    say(given() != Given::yes, {.news = AutopilotNews::ready, .given = given()}, now);
  } else if (event == Event::disarmed) {
    // With a DO_LAND_START in its mission an ArduPlane does not arm again.
    if (from == State::landing && traits_.touch_down) {
      mavlink::MissionClearAll clear;
      clear.target_system = system_;
      clear.target_component = mavlink::kComponentAutopilot;
      send(clear);
    }
    say(false, {AutopilotNews::disarmed}, now);
  } else if (event == Event::not_obeyed) {
    say(true, {.news = AutopilotNews::not_armed, .given = given()}, now);
  } else if (event == Event::not_ours && before_loss_ == State::arming) {
    say(true, {.news = AutopilotNews::launch_broken_off, .given = given()}, now);
  }
}

void Companion::Impl::begin_climb(Instant now) {
  custody_.fire(Custody::Event::launched);
  climbed_ = true;
  climb_by_ = now + kLaunchWithin + from_seconds(params_.takeoff_height_m / kClimbMin_mps);
  say(false, {AutopilotNews::taking_off}, now);
  if (!traits_.is_lifted) return;
  mavlink::CommandLong takeoff = command_of(Command::nav_takeoff);
  takeoff.param7 = static_cast<float>(params_.takeoff_height_m);
  ask(takeoff, {}, true);
}

/// A plane is taken over a little below its take-off height, and before the mission nothing is
/// commanded: in GUIDED it would stay so low, and begin its first plan there.
void Companion::Impl::finish_climb() {
  if (traits_.flies_to_points || traits_.hovers_first) return;
  ask(command_of(Command::do_change_altitude, params_.takeoff_height_m,
                 static_cast<double>(mavlink::Frame::global_relative_alt)),
      {}, true);
}

/// A place to fly to, which may be where it is, is flown to on its wings. In GUIDED alone: the mode
/// may have become its pilot's.
void Companion::Impl::leave_hover(Instant now) {
  if (!hovers() || !high()) return leaves_hover_since_.reset();
  if (!leaves_hover_since_) {
    leaves_hover_since_ = now;
  } else if (now - *hover_left_at_ < kLeaveAgain) {
    return;
  }
  hover_left_at_ = now;
  constexpr double kNoSpeed = -1.0;
  constexpr double kWithoutChangeOfMode = 0.0;
  mavlink::CommandLong place = command_of(Command::do_reposition, kNoSpeed, kWithoutChangeOfMode);
  // Its height is that of the place from now on, until another is asked for.
  place.param7 =
      static_cast<float>(std::max(motion_.relative_height_m(), params_.takeoff_height_m));
  height_sent_.reset();
  height_at_.reset();
  ask(place, {}, true);
}

void Companion::Impl::enter_piloted(State from, Event event, Instant now) {
  if (from == State::checking && before_loss_ == State::piloted) {
    // Nobody has taken it anew: a word of the operator from before the loss counts.
    return say(false, {.news = AutopilotNews::still_piloted, .detail = mode()}, now);
  }
  if (from != State::checking) desk_.clear();
  custody_.fire(Custody::Event::taken_by_others);
  taken_at_ = now;
  say(true, why_piloted(from, event), now);
}

void Companion::Impl::enter_loss(State from, std::uint32_t mode_before, Instant now) {
  if (from == State::lost || from == State::silent) return;
  desk_.clear();
  lost_at_ = now;
  if (from != State::checking) {
    before_loss_ = from;
    mode_before_loss_ = mode_before;
  }
  say(true, {machine_.in(State::lost) ? AutopilotNews::no_frames : AutopilotNews::silent}, now);
}

void Companion::Impl::entered(State from, Event event, Instant now) {
  const std::uint32_t mode_before = entry_.mode;
  entry_ = {.mode = mode_, .retry_at = now, .at = now};
  if (from == State::arming) custody_.fire(Custody::Event::in_use);
  switch (machine_.state()) {
    case State::searching:
      reset_link();
      say(true,
          {event == Event::rebooted     ? AutopilotNews::rebooted
           : event == Event::given_back ? AutopilotNews::looked_for
                                        : AutopilotNews::gone},
          now);
      break;
    case State::refused:
      reset_link();
      break;
    case State::preparing:
      said_refusal_.reset();
      say(false, {.news = AutopilotNews::found, .number = system_, .detail = mode()}, now);
      break;
    case State::standing_by:
      enter_standing_by(from, event, now);
      break;
    case State::climbing:
      if (from == State::arming) begin_climb(now);
      break;
    case State::landing:
      told_too_low_ = false;
      say(false, {AutopilotNews::landing}, now);
      break;
    case State::flying:
      on_ground_since_.reset();
      sank_at_.reset();
      sinks_from_m_ = kSlowedFrom_m;
      forget_landing();
      speed_sent_.reset();
      height_sent_.reset();
      height_at_.reset();
      height_error_.reset();
      flown_at_.reset();
      target_at_ = now;
      leaves_hover_since_.reset();
      say(false, {AutopilotNews::flying}, now);
      if (std::exchange(climbed_, false)) finish_climb();
      break;
    case State::piloted:
      enter_piloted(from, event, now);
      break;
    case State::lost:
    case State::silent:
      enter_loss(from, mode_before, now);
      break;
    case State::checking:
      // A reboot in the first seconds after another shows in no uptime, and forgets the streams.
      if (now - lost_at_ > kStreamsForgotten) ask_streams();
      break;
    case State::duplicated:
      if (from != State::lost && from != State::silent && from != State::checking) {
        before_loss_ = from;
      }
      desk_.clear();
      while (packets_.pop()) {
      }
      say(true, {.news = AutopilotNews::duplicate_node, .number = duplicate_node_}, now);
      break;
    default:
      break;
  }
}

Companion::Companion(const CompanionParams& params, const MissionOrigin& origin, Instant now)
    : impl_{std::make_unique<Impl>(params, origin, now)} {}
Companion::~Companion() = default;

void Companion::on_bytes(std::span<const std::uint8_t> bytes, Instant now) {
  impl_->on_bytes(bytes, now);
}
void Companion::on_frame_heard(Instant now) { impl_->on_frame_heard(now); }
void Companion::on_reboot(Instant now) { impl_->on_reboot(now); }
void Companion::on_duplicate(std::uint8_t node_id, Instant now) {
  impl_->on_duplicate(node_id, now);
}
void Companion::on_link_trouble(std::optional<AutopilotNotice> trouble) {
  impl_->on_link_trouble(std::move(trouble));
}
const std::vector<AutopilotNotice>& Companion::troubles() const { return impl_->troubles(); }
std::optional<AutopilotFacts> Companion::facts(Instant now) const { return impl_->facts(now); }
std::optional<Companion::Heard> Companion::heartbeat() const { return impl_->heartbeat(); }
std::optional<Companion::Heard> Companion::other_heartbeat() const {
  return impl_->other_heartbeat();
}
void Companion::command(const Demand& demand, Instant now) { impl_->command(demand, now); }
bool Companion::give_back(Instant now, Instant issued) { return impl_->give_back(now, issued); }
void Companion::keep_fence(const Fence& fence) { impl_->keep_fence(fence); }
void Companion::step(Instant now) { impl_->step(now); }
std::optional<mavlink::WireBytes> Companion::poll_packet() {
  return may_send() ? impl_->poll_packet() : std::nullopt;
}
std::optional<Notice> Companion::poll_notice() { return impl_->poll_notice(); }
std::optional<MotionSample> Companion::sample() const { return impl_->sample(); }
Companion::State Companion::state() const { return impl_->machine().state(); }
std::optional<bool> Companion::in_use() const { return impl_->in_use(); }
std::string Companion::mode() const { return impl_->mode(); }
std::uint64_t Companion::protocol_errors() const { return impl_->machine().protocol_errors(); }
const mavlink::ParserStatistics& Companion::parser() const { return impl_->parser(); }

}  // namespace skein::ardupilot
