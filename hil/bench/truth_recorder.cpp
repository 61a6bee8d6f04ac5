// SPDX-License-Identifier: Apache-2.0
#include "truth_recorder.hpp"

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <stop_token>
#include <system_error>
#include <thread>
#include <utility>

#include "skein/base/angles.hpp"
#include "skein/base/vectors.hpp"
#include "skein/mavlink/enums.hpp"
#include "skein/mavlink/parser.hpp"
#include "skein/recording/writer.hpp"
#include "skein/system/descriptor.hpp"
#include "skein/version/version.hpp"

namespace skein::hil {
namespace {

using namespace std::chrono_literals;
using std::chrono::steady_clock;

constexpr float kPeriod_us = 50'000.0F;
constexpr auto kAskAgain = 1s;
constexpr int kWake_ms = 100;
constexpr std::uint8_t kOurSystem = 254;  // nobody's: the companion has the autopilot's own
constexpr double kStill_mps = 0.5;

VehicleState state_of(const mavlink::SimState& told, double geoid_height_m,
                      const MissionOrigin& origin, Instant now) {
  const double height_m = static_cast<double>(told.alt) + geoid_height_m;
  const Vec3 at = origin.to_enu({told.lat_int * 1e-7, told.lon_int * 1e-7, height_m}).metres();
  const Vec2 velocity{static_cast<double>(told.ve), static_cast<double>(told.vn)};
  VehicleState state;
  state.time = now;
  state.x_m = at.x();
  state.y_m = at.y();
  state.z_m = height_m - origin.origin().height_m;
  state.heading_rad = heading_from_compass_deg(degrees(static_cast<double>(told.yaw)));
  state.groundspeed_mps = velocity.norm();
  state.course_rad = state.groundspeed_mps < kStill_mps ? state.heading_rad
                                                        : std::atan2(velocity.y(), velocity.x());
  state.climb_mps = -static_cast<double>(told.vd);
  return state;
}

/// One simulator: its socket, who speaks there, what it said.
class Source {
 public:
  Source(const SimulatedAircraft& aircraft, system::Descriptor socket)
      : aircraft_{aircraft}, socket_{std::move(socket)} {}

  [[nodiscard]] int socket() const { return socket_.get(); }
  [[nodiscard]] std::uint16_t port() const {
    sockaddr_in own{};
    socklen_t size = sizeof own;
    ::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&own), &size);
    return ntohs(own.sin_port);
  }
  Result<void> record(const std::filesystem::path& folder, std::int64_t epoch_unix_ns) {
    recording::Writer::Options options;
    options.session = {aircraft_.vehicle, {}, "skein-hil", version(), epoch_unix_ns, ""};
    auto writer =
        recording::Writer::open(folder / recording::folder_name(aircraft_.vehicle), options);
    if (!writer) return writer.error();
    writer_.emplace(std::move(writer).value());
    return {};
  }

  void hear(const MissionOrigin& origin, Instant now) {
    std::array<std::uint8_t, 2048> bytes{};
    while (true) {
      sockaddr_in from{};
      socklen_t size = sizeof from;
      const ssize_t count = ::recvfrom(socket_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT,
                                       reinterpret_cast<sockaddr*>(&from), &size);
      if (count < 0) return;
      speaker_ = from;
      parser_.parse({bytes.data(), static_cast<std::size_t>(count)},
                    [&](const mavlink::Packet& packet) {
                      const auto told = mavlink::decode<mavlink::SimState>(packet);
                      if (!told || packet.system != aircraft_.system_id) return;
                      told_at_ = steady_clock::now();
                      writer_->write(recording::TrackPoint{
                          state_of(*told, aircraft_.geoid_height_m, origin, now), 0, 0.0, 0.0});
                    });
    }
  }
  /// Again and again, while it speaks of everything else.
  void ask() {
    const auto now = steady_clock::now();
    if (!speaker_ || now < told_at_ + kAskAgain || now < asked_at_ + kAskAgain) return;
    asked_at_ = now;
    mavlink::CommandLong command;
    command.command = static_cast<std::uint16_t>(mavlink::Command::set_message_interval);
    command.target_system = aircraft_.system_id;
    command.target_component = mavlink::kComponentAutopilot;
    command.param1 = static_cast<float>(mavlink::SimState::kDefinition.id);
    command.param2 = kPeriod_us;
    const auto packet = encoder_.encode(command);
    (void)::sendto(socket_.get(), packet.begin(), packet.size(), MSG_DONTWAIT,
                   reinterpret_cast<const sockaddr*>(&*speaker_), sizeof *speaker_);
  }
  void flush() { (void)writer_->flush(); }

 private:
  SimulatedAircraft aircraft_;
  system::Descriptor socket_;
  std::optional<sockaddr_in> speaker_;
  steady_clock::time_point told_at_{};
  steady_clock::time_point asked_at_{};
  mavlink::Parser parser_;
  mavlink::Encoder encoder_{kOurSystem, mavlink::kComponentOnboardComputer};
  std::optional<recording::Writer> writer_;
};

}  // namespace

std::vector<SimulatedAircraft> simulated_aircraft(
    const std::vector<configuration::VehicleConfig>& vehicles,
    const std::function<bool(VehicleId)>& is_external) {
  std::vector<SimulatedAircraft> aircraft;
  for (const configuration::VehicleConfig& config : vehicles) {
    const auto& controller = config.flight_controller;
    if (controller.kind != configuration::FlightControllerKind::ardupilot) continue;
    if (is_external(config.vehicle.id)) continue;
    aircraft.push_back(
        {config.vehicle.id, controller.ardupilot.system_id, controller.ardupilot.geoid_height_m});
  }
  return aircraft;
}

class TruthRecorder::Impl {
 public:
  explicit Impl(const MissionOrigin& origin) : origin_{origin} {}

  Result<void> add(const SimulatedAircraft& aircraft) {
    system::Descriptor socket{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
    sockaddr_in own{};
    own.sin_family = AF_INET;
    own.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (!socket || ::bind(socket.get(), reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0) {
      return Error{"no port for what an aircraft really does: " +
                   std::generic_category().message(errno)};
    }
    sources_.emplace(aircraft.vehicle, std::make_unique<Source>(aircraft, std::move(socket)));
    return {};
  }
  [[nodiscard]] std::uint16_t port(VehicleId vehicle) const { return sources_.at(vehicle)->port(); }

  Result<void> record(const std::filesystem::path& folder, std::int64_t epoch_unix_ns,
                      std::function<Instant()> mission_now) {
    for (auto& [id, source] : sources_) {
      if (auto opened = source->record(folder, epoch_unix_ns); !opened) return opened;
    }
    thread_ = std::jthread{
        [this, now = std::move(mission_now)](const std::stop_token& stop) { listen(stop, now); }};
    return {};
  }

 private:
  void listen(const std::stop_token& stop, const std::function<Instant()>& now) {
    std::vector<pollfd> items;
    for (const auto& [id, source] : sources_) items.push_back({source->socket(), POLLIN, 0});
    while (!stop.stop_requested()) {
      (void)::poll(items.data(), items.size(), kWake_ms);
      for (auto& [id, source] : sources_) {
        source->hear(origin_, now());
        source->ask();
      }
    }
    for (auto& [id, source] : sources_) source->flush();
  }

  MissionOrigin origin_;
  std::map<VehicleId, std::unique_ptr<Source>> sources_;
  std::jthread thread_;  // last: it ends first
};

TruthRecorder::TruthRecorder(std::unique_ptr<Impl> impl) : impl_{std::move(impl)} {}
TruthRecorder::~TruthRecorder() = default;

Result<std::unique_ptr<TruthRecorder>> TruthRecorder::open(
    const std::vector<SimulatedAircraft>& aircraft, const Wgs84& origin) {
  const auto frame = MissionOrigin::make(origin);
  if (!frame) return frame.error();
  auto impl = std::make_unique<Impl>(*frame);
  for (const SimulatedAircraft& one : aircraft) {
    if (auto added = impl->add(one); !added) return added.error();
  }
  return std::unique_ptr<TruthRecorder>{new TruthRecorder{std::move(impl)}};
}

std::uint16_t TruthRecorder::port(VehicleId vehicle) const { return impl_->port(vehicle); }

Result<void> TruthRecorder::record(const std::filesystem::path& run_folder,
                                   std::int64_t epoch_unix_ns,
                                   std::function<Instant()> mission_now) {
  return impl_->record(run_folder / kTruthFolder, epoch_unix_ns, std::move(mission_now));
}

}  // namespace skein::hil
