// SPDX-License-Identifier: Apache-2.0
#include "user_autopilots.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <system_error>

#include "skein/base/angles.hpp"
#include "skein/base/attitude.hpp"
#include "skein/base/frames.hpp"
#include "skein/can/bus.hpp"
#include "skein/can/mcast_datagram.hpp"
#include "skein/hil/bench.hpp"
#include "skein/hil/child_process.hpp"

namespace skein::hil {
namespace {

constexpr std::uint32_t kNodeMask = 0x7F;
constexpr std::uint8_t kAnyNode = 0;
constexpr auto kListen = std::chrono::seconds{1};
constexpr auto kBoot = std::chrono::seconds{60};
/// What a navigation filter takes until it can be armed, and the climb.
constexpr double kReady_s = 60.0;
constexpr double kEmulatedReady_s = 20.0;
constexpr double kClimb_mps = 3.0;
/// TKOFF_DIST: a plane that takes off waits so far ahead of where it stood.
constexpr double kTakeoffDistance_m = 200.0;
/// Q_ASSIST_SPEED below the least airspeed: gusts shall not start a quadplane's rotors.
constexpr double kAssistBelow_mps = 4.0;
/// Over that of the places, to catch up with them.
constexpr double kClimbReserve = 1.2;
/// WPNAV_ACCEL_Z: ArduCopter's own 1 m/s^2 is late for places that gain speed at 2.
constexpr double kVerticalAcceleration_mps2 = 2.5;
/// An aircraft slips in its turns, and rolls past the bank that is asked for.
constexpr double kBankReserve_deg = 10.0;
constexpr double kBankMax_deg = 65.0;

Result<void> run(const std::vector<std::string>& command) {
  auto child = ChildProcess::start(command, "/dev/null", {});
  if (!child) return child.error();
  if (!child->wait(std::chrono::seconds{5}) || !child->ended() || !child->clean()) {
    std::string words;
    for (const std::string& word : command) words += (words.empty() ? "" : " ") + word;
    return Error{words + ": failed"};
  }
  return {};
}

/// Where datagrams to it would go.
bool bus_is_on_loopback() {
  const int s = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (s < 0) return false;
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(can::kMcastPort);
  to.sin_addr.s_addr = htonl(can::kMcastGroup);
  sockaddr_in from{};
  socklen_t size = sizeof from;
  const bool there = ::connect(s, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0 &&
                     ::getsockname(s, reinterpret_cast<sockaddr*>(&from), &size) == 0;
  ::close(s);
  return there && from.sin_addr.s_addr == htonl(INADDR_LOOPBACK);
}

/// Whether that node of the bus speaks within that time.
Result<bool> speaks_on_bus(const std::string& name, std::uint8_t node_id,
                           std::chrono::seconds at_most) {
  auto bus = can::open(name);
  if (!bus) return bus.error();
  const auto until = std::chrono::steady_clock::now() + at_most;
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        until - std::chrono::steady_clock::now());
    if (left.count() <= 0) return false;
    pollfd item{(*bus)->descriptor(), POLLIN, 0};
    (void)::poll(&item, 1, static_cast<int>(left.count()));
    while (const auto frame = (*bus)->receive()) {
      if (node_id == kAnyNode || (frame->id & kNodeMask) == node_id) return true;
    }
  }
}

/// As its simulator calls it.
std::string model_of(Airframe airframe, const UserAutopilots& autopilots) {
  switch (airframe) {
    case Airframe::copter:
      return "quad";
    case Airframe::quadplane:
      return "quadplane";
    case Airframe::plane:
    case Airframe::count:
      break;
  }
  return autopilots.plane_model;
}

void write_to(const char* file, const std::string& text) { std::ofstream{file} << text; }

}  // namespace

Result<UserAutopilots> user_autopilots(const std::vector<std::string>& programs,
                                       const std::vector<std::string>& parameters,
                                       const std::string& plane_model) {
  UserAutopilots all;
  if (!plane_model.empty()) all.plane_model = plane_model;
  for (const std::string& text : programs) {
    const std::filesystem::path program = std::filesystem::absolute(text);
    const std::string name = program.filename().string();
    const bool copter = name.find("copter") != std::string::npos;
    if (::access(program.c_str(), X_OK) != 0 || std::filesystem::is_directory(program)) {
      return Error{"--autopilot " + text +
                   ": not an executable program; give a build of ArduPilot for software in the "
                   "loop (docs/ardupilot.md says how to get one)"};
    }
    if (!copter && name.find("plane") == std::string::npos) {
      return Error{"--autopilot " + text +
                   ": its name does not say what it flies; call it arduplane or arducopter"};
    }
    auto& place = copter ? all.copter : all.plane;
    if (place)
      return Error{"--autopilot: two programs for " + std::string{copter ? "copters" : "planes"}};
    place = program;
  }
  for (const std::string& file : parameters) {
    if (!std::filesystem::exists(file)) {
      return Error{"--autopilot-parameters " + file + ": there is no such file"};
    }
    all.parameters.push_back(std::filesystem::absolute(file));
  }
  return all;
}

double climb_needed_mps(const VehicleSpec& copter) {
  constexpr double kLeast_mps = 1.0;
  return std::max(kLeast_mps, kClimbReserve * copter.cruise_speed_mps);
}

std::string autopilot_parameters(const configuration::VehicleConfig& vehicle) {
  const VehicleSpec& spec = vehicle.vehicle;
  const configuration::ArdupilotConfig& fc = vehicle.flight_controller.ardupilot;
  const configuration::WindConfig& wind = vehicle.flight_controller.wind;
  std::string text;
  const auto set = [&text](const char* name, double value) {
    text += fmt::format("{} {:.6g}\n", name, value);
  };
  set("SYSID_THISMAV", fc.system_id);
  set("SYSID_MYGCS", fc.system_id);
  set("CAN_P1_DRIVER", 1);
  set("CAN_P1_BITRATE", 1'000'000);
  set("CAN_D1_PROTOCOL", 1);
  set("CAN_D1_UC_NODE", fc.node_id);
  set("CAN_D1_UC_SER_EN", 1);
  set("CAN_D1_UC_S1_NOD", fc.companion_node_id);
  set("CAN_D1_UC_S1_IDX", fc.serial_id);
  set("CAN_D1_UC_S1_BD", 115);
  set("CAN_D1_UC_S1_PRO", 2);
  set("SIM_CAN_TYPE1", 1);  // multicast
  set("SIM_CAN_TYPE2", 0);
  set("SIM_WIND_SPD", wind.speed_mps);
  set("SIM_WIND_DIR", compass_deg_from_heading(wind.from_rad));
  set("SIM_WIND_TURB", wind.gust_mps);
  if (vehicle.fence.exists()) {
    set("FENCE_ENABLE", 1);
    set("FENCE_ACTION", 1);
    set("FENCE_TYPE", 5);  // greatest height, and polygons
    set("FENCE_ALT_MAX", vehicle.fence.height_max_m);
  }
  if (spec.is_copter()) {
    set("FS_GCS_ENABLE", 1);
    if (configuration::flies_formation(spec)) {
      const double climb_cmps = std::ceil(100.0 * climb_needed_mps(spec));
      set("WPNAV_SPEED_UP", climb_cmps);
      set("WPNAV_SPEED_DN", climb_cmps);
      set("WPNAV_ACCEL_Z", 100.0 * kVerticalAcceleration_mps2);
    }
    return text;
  }
  if (spec.airframe == Airframe::quadplane) {
    set("Q_ENABLE", 1);
    set("Q_ASSIST_SPEED", std::max(1.0, std::floor(spec.speed_min_mps - kAssistBelow_mps)));
  } else {
    set("TKOFF_ALT", fc.takeoff_height_m);
  }
  set("FS_GCS_ENABL", 1);
  set("FS_LONG_ACTN", 1);
  set("AIRSPEED_CRUISE", spec.cruise_speed_mps);
  set("AIRSPEED_MAX", std::ceil(spec.speed_max_mps));
  const double bank_deg = degrees(std::atan(spec.cruise_speed_mps * spec.cruise_speed_mps /
                                            (kGravity_mps2 * spec.turn_radius_m)));
  const double roll_limit_deg = std::min(kBankMax_deg, std::ceil(bank_deg + kBankReserve_deg));
  set("ROLL_LIMIT_DEG", roll_limit_deg);
  // In turns it is raised by the root of the load factor (STALL_PREVENTION).
  set("AIRSPEED_MIN",
      std::floor(spec.speed_min_mps * std::sqrt(std::cos(radians(roll_limit_deg)))));
  // Pitch keeps the height, and throttle the airspeed.
  set("TECS_SPDWEIGHT", 0.0);
  set("WP_LOITER_RAD", std::ceil(spec.planning_radius_m()));
  return text;
}

Result<std::vector<std::string>> autopilot_command(const UserAutopilots& autopilots,
                                                   const configuration::VehicleConfig& vehicle,
                                                   int instance, std::uint16_t truth_port,
                                                   const std::filesystem::path& folder) {
  const VehicleSpec& spec = vehicle.vehicle;
  const std::filesystem::path& program = *autopilots.of(spec);
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  const auto own = std::filesystem::absolute(folder / "vehicle.parm");
  std::ofstream{own} << autopilot_parameters(vehicle);
  if (!std::filesystem::exists(own)) return Error{own.string() + ": cannot be written"};

  std::string defaults;
  const auto add = [&defaults](const std::filesystem::path& file) {
    defaults += (defaults.empty() ? "" : ",") + file.string();
  };
  const auto beside = program.parent_path() / (std::string{to_string(spec.airframe)} + ".parm");
  if (std::filesystem::exists(beside)) add(beside);
  for (const auto& file : autopilots.parameters) add(file);
  add(own);

  const auto origin = MissionOrigin::make(vehicle.origin);
  if (!origin) return origin.error();
  const double run_m = spec.lifts_off() ? 0.0 : kTakeoffDistance_m;
  const Vec2 start = vehicle.start.position() - run_m * unit_vector(vehicle.start.heading_rad);
  const Wgs84 home = origin->to_wgs84({start.x(), start.y(), 0.0});
  const double height_m = home.height_m - vehicle.flight_controller.ardupilot.geoid_height_m;
  // clang-format off
  return std::vector<std::string>{
      "/bin/sh", "-c", "cd \"$1\" && shift && exec \"$@\"", "sh", std::filesystem::absolute(folder).string(),
      program.string(),
      "--model", model_of(spec.airframe, autopilots),
      "--speedup", "1",
      "--instance", std::to_string(instance),
      "--home", fmt::format("{:.8f},{:.8f},{:.2f},{:.1f}", home.latitude_deg, home.longitude_deg,
                            height_m, compass_deg_from_heading(vehicle.start.heading_rad)),
      "--wipe",
      "--defaults", defaults,
      "--serial0", "udpclient:127.0.0.1:" + std::to_string(truth_port), "--serial1", "none", "--serial2", "none"};
  // clang-format on
}

Result<void> autopilot_bus_is_free() {
  const auto spoken = speaks_on_bus(kAutopilotBus, kAnyNode, kListen);
  if (!spoken) return spoken.error();
  if (!*spoken) return {};
  return Error{std::string{"somebody speaks on "} + kAutopilotBus +
               " already; stop other autopilots on this machine"};
}

Result<void> await_autopilot(const configuration::VehicleConfig& vehicle, ChildProcess& started,
                             const std::filesystem::path& log) {
  const auto& fc = vehicle.flight_controller.ardupilot;
  const auto speaks = speaks_on_bus(fc.can, fc.node_id, kBoot);
  if (!speaks) return speaks.error();
  if (*speaks) return {};
  const auto how = started.ended();
  return Error{
      fmt::format("the autopilot of vehicle {} is not heard on {} as node {}{}; its log is {}",
                  vehicle.vehicle.id.value, fc.can, fc.node_id, how ? "; it ended: " + *how : "",
                  log.string())};
}

double take_off_lead_s(const VehicleSpec& vehicle, bool emulated) {
  const double ready_s = emulated ? kEmulatedReady_s : kReady_s;
  return ready_s + std::max(vehicle.height_m, kHover_m) / kClimb_mps;
}

Result<void> keep_autopilots_on_loopback(bool reached) {
  if (bus_is_on_loopback()) return {};
  const std::string by_hand =
      "as root: ip link set lo multicast on; ip route add 239.65.82.0/24 dev lo";
  if (reached) {
    return Error{
        "--autopilot and --console: the autopilots' bus would leave this machine, and in a network "
        "of their own nobody reaches the console; " +
        by_hand};
  }
  const uid_t user = ::geteuid();
  const gid_t group = ::getegid();
  if (::unshare(CLONE_NEWNET) != 0) {
    if (::unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) {
      return Error{"cannot make a network for the autopilots: " +
                   std::generic_category().message(errno) + "; " + by_hand};
    }
    write_to("/proc/self/setgroups", "deny");
    write_to("/proc/self/uid_map", fmt::format("0 {} 1", user));
    write_to("/proc/self/gid_map", fmt::format("0 {} 1", group));
  }
  const std::string ip = ::access("/usr/sbin/ip", X_OK) == 0 ? "/usr/sbin/ip" : "/sbin/ip";
  for (const auto& command :
       {std::vector<std::string>{ip, "link", "set", "lo", "up", "multicast", "on"},
        std::vector<std::string>{ip, "route", "add", "239.0.0.0/8", "dev", "lo"}}) {
    if (auto done = run(command); !done) return done;
  }
  return {};
}

}  // namespace skein::hil
