// SPDX-License-Identifier: Apache-2.0
#include "arguments.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>

#include "skein/base/angles.hpp"
#include "skein/command_line/read.hpp"
#include "skein/mavlink/signing.hpp"
#include "skein/version/version.hpp"

namespace skein::hil {
namespace {

constexpr const char* kDescription =
    "A flight controller as its own process on a CAN bus, with the aircraft that it flies: speaks\n"
    "DroneCAN and MAVLink 2 as ArduPilot 4.6 (Plane, Copter) does through a DroneCAN serial port, "
    "in real\n"
    "time. A board or a software-in-the-loop build of ArduPilot can take its place.";

constexpr const char* kFooter =
    "Examples:\n"
    "  skein-fc --bus mcast:3 --airborne --start 2200 2000 300 --heading 50\n"
    "      in flight over the scenario's origin, armed, in GUIDED, for the companion node 42\n"
    "  skein-fc --bus vcan0 --node 11 --companion 43 --system 7 --failsafe \\\n"
    "           --wind-speed 5 --wind-from 240 --gusts 5 --seed 7\n"
    "      on the ground, disarmed, in MANUAL\n"
    "  skein-fc --airframe copter\n"
    "      a hexarotor on the ground, in STABILIZE\n"
    "  skein-fc --airframe quadplane\n"
    "      a plane with four rotors that lift it off and set it down\n"
    "  skein-fc --airborne --at '30 mode RTL' --at '60 silent on'\n"
    "      the pilot takes over after 30 s, and after 60 s nothing more is heard of it\n"
    "\n"
    "Standard input takes what the companion cannot do, a line each:\n"
    "  mode NAME             the pilot's switch. Plane: MANUAL FBWA RTL LOITER TAKEOFF GUIDED,\n"
    "                        quadplane: QLOITER QLAND QRTL, too;\n"
    "                        copter: STABILIZE GUIDED LOITER RTL LAND\n"
    "  arm, disarm           the pilot's sticks; disarm works in flight, too\n"
    "  reboot                the autopilot restarts: 1.2 s off the bus, MAVLink after 5.2 s;\n"
    "                        in flight it comes back armed and in LOITER\n"
    "  silent on|off         it sends nothing, but hears and flies on\n"
    "  position lost|good    the navigation filter\n"
    "  prearm REASON         it would not arm, and says why: 'PreArm: REASON'; without a reason:\n"
    "                        it would again\n"
    "  remote-id on|off      power of its transmitter of Remote ID (--remote-id)\n"
    "  battery PERCENT       so much is left of it from now on, as its gauge tells, too\n"
    "\n"
    "Standard output says 'ready' once it is on the bus. It ends with status 0 on SIGINT or\n"
    "SIGTERM; 2 means bad arguments, 3 that the bus cannot be used.";

/// A copter's speed, where none is said.
constexpr double kCopterSpeed_mps = 10.0;
// Of a quadplane: ArduPilot's simulated one flies so.
constexpr double kQuadplaneSpeed_mps = 25.0;
constexpr double kQuadplaneSpeedMin_mps = 18.0;
constexpr double kQuadplaneSpeedMax_mps = 30.0;
constexpr double kQuadplaneTurn_m = 100.0;

/// "30 mode RTL".
std::optional<TimedLine> timed_line(const std::string& text) {
  std::istringstream words{text};
  double seconds = 0.0;
  TimedLine out;
  if (!(words >> seconds >> std::ws) || !(seconds >= 0.0 && seconds < 1e6)) return std::nullopt;
  if (!std::getline(words, out.line) || out.line.empty()) return std::nullopt;
  out.after = from_seconds(seconds);
  return out;
}

/// What is said in people's units.
struct Texts {
  std::array<double, 3> origin{31.522062, 105.044327, 480.0};
  std::array<double, 3> start{0.0, 0.0, 0.0};
  double heading_deg = 0.0;
  double wind_mps = 0.0;
  double wind_from_deg = 0.0;
  int node = 10;
  int companion = 42;
  int serial = 0;
  int system = 1;
  std::optional<int> companion_system;
  std::string airframe = "plane";
  std::optional<double> speed_mps;
  bool no_noise = false;
  std::string signing_key;
  std::vector<std::string> at;
};

std::vector<std::string> airframe_names() {
  std::vector<std::string> names;
  for (std::uint8_t i = 0; i < static_cast<std::uint8_t>(Airframe::count); ++i) {
    names.emplace_back(to_string(static_cast<Airframe>(i)));
  }
  return names;
}
/// Precondition: it is one of airframe_names().
Airframe airframe_named(const std::string& name) {
  const auto names = airframe_names();
  return static_cast<Airframe>(std::ranges::find(names, name) - names.begin());
}

/// What is not given, where the airframe does not fly a plane's defaults.
void set_defaults(const CLI::App& app, EmulatorConfig& c) {
  const auto set = [&app](const char* option, double& value, double otherwise) {
    if (app.count(option) == 0) value = otherwise;
  };
  if (c.airframe == Airframe::copter) set("--speed", c.airspeed_mps, kCopterSpeed_mps);
  if (c.airframe != Airframe::quadplane) return;
  set("--speed", c.airspeed_mps, kQuadplaneSpeed_mps);
  set("--speed-min", c.airspeed_min_mps, kQuadplaneSpeedMin_mps);
  set("--speed-max", c.airspeed_max_mps, kQuadplaneSpeedMax_mps);
  set("--turn-radius", c.turn_radius_m, kQuadplaneTurn_m);
}

/// False where it cannot be read: that has been said.
bool read_signing_key(const std::string& file, EmulatorConfig& config) {
  if (file.empty()) return true;
  std::ifstream in{file};
  const std::string text{std::istreambuf_iterator<char>{in}, {}};
  const auto key = in ? mavlink::key_from_text(text) : Error{"cannot be read"};
  if (!key) {
    std::fprintf(stderr, "skein-fc: --signing-key %s: %s\n", file.c_str(),
                 key.error().message.c_str());
    return false;
  }
  config.signing_key = *key;
  return true;
}

/// How it is reached.
void add_link_options(CLI::App& app, FcArguments& a, Texts& t) {
  EmulatorConfig& c = a.config;
  app.add_option("--bus", a.bus, "CAN bus: mcast:N, mcast:N@INTERFACE, can0, vcan0")
      ->capture_default_str();
  app.add_option("--node", t.node, "Its DroneCAN node")
      ->check(CLI::Range(1, 127))
      ->capture_default_str();
  app.add_option("--companion", t.companion, "Node that may use its serial port")
      ->check(CLI::Range(1, 127))
      ->capture_default_str();
  app.add_option("--serial", t.serial, "Number of the serial port")
      ->check(CLI::Range(0, 15))
      ->capture_default_str();
  app.add_flag("--no-serial{false}", c.serial_port,
               "Without serial ports over CAN (CAN_D1_UC_SER_EN 0)");
  app.add_flag("--no-mavlink{false}", c.mavlink,
               "Its serial port speaks no MAVLink (CAN_D1_UC_S1_PRO -1)");
  app.add_flag("--fd", c.fd, "Send CAN FD frames");
  app.add_option("--system", t.system, "Its MAVLink system")
      ->check(CLI::Range(1, 255))
      ->capture_default_str();
  app.add_option("--companion-system", t.companion_system,
                 "MAVLink system whose heartbeat the failsafe waits for (default: its own)")
      ->check(CLI::Range(1, 255));
  app.add_option(
      "--signing-key", t.signing_key,
      "File with the key of MAVLink's signatures, 64 hexadecimal digits or a passphrase:\n"
      "it signs, and heeds nothing unsigned");
  app.add_flag("--remote-id", c.remote_id,
               "It has a transmitter of Remote ID, and does not arm while that is not told what it "
               "must say\n(DID_ENABLE 1, DID_OPTIONS 1)");
  app.add_flag("--failsafe", c.companion_failsafe,
               "RTL 5 s after the last heartbeat of the companion");
  app.add_option("--without", c.unknown_parameters,
                 "A parameter that it does not know, such as FS_LONG_ACTN; several times, if need "
                 "be");
}

/// What flies, from where, in what air.
void add_flight_options(CLI::App& app, FcArguments& a, Texts& t) {
  EmulatorConfig& c = a.config;
  app.add_option("--airframe", t.airframe, "The kind of aircraft")
      ->check(CLI::IsMember(airframe_names()))
      ->capture_default_str();
  app.add_option("--origin", t.origin, "LATITUDE LONGITUDE HEIGHT: degrees, m above the ellipsoid")
      ->capture_default_str();
  app.add_option("--start", t.start, "EAST NORTH HEIGHT, m from the origin; height only in flight")
      ->capture_default_str();
  app.add_option("--heading", t.heading_deg, "At the start, degrees from north, clockwise")
      ->capture_default_str();
  auto* airborne = app.add_flag("--airborne", c.airborne, "Start in flight, armed");
  app.add_option("--mode", c.mode, "At the start in flight, as ArduPilot names it")
      ->needs(airborne)
      ->capture_default_str();
  app.add_option("--hold-until", a.hold_until_unix_ns,
                 "In flight it stands still at its start until that system time, ns since 1970")
      ->needs(airborne);
  app.add_option("--speed", t.speed_mps,
                 "Cruise airspeed of a plane (default: 50; of a quadplane 25, with least and "
                 "greatest 18 and\n30), greatest speed of a copter (10), m/s");
  app.add_option("--climb", c.climb_mps, "Of a copter, up and down, m/s")->capture_default_str();
  app.add_option("--speed-min", c.airspeed_min_mps, "Least airspeed of a plane, m/s")
      ->capture_default_str();
  app.add_option("--speed-max", c.airspeed_max_mps, "Greatest airspeed of a plane, m/s")
      ->capture_default_str();
  app.add_option("--turn-radius", c.turn_radius_m,
                 "m, of a plane at cruise: the bank limit is that of this circle and 5 "
                 "degrees,\n10 of a small plane")
      ->capture_default_str();
  app.add_option("--battery", c.battery_mah,
                 "mAh of a full battery: it gives 0.5 A, and 60 A more at full throttle")
      ->capture_default_str();
  app.add_option("--wind-speed", t.wind_mps, "Steady wind, m/s")
      ->check(command_line::number_in(0.0, 25.0))
      ->capture_default_str();
  app.add_option("--wind-from", t.wind_from_deg, "Where it comes from, degrees from north")
      ->capture_default_str();
  app.add_option("--gusts", c.gusts_wind_mps,
                 "Dryden gusts as a wind of this speed at 6 m makes them, m/s; their standard\n"
                 "deviation at 300 m is a tenth of it")
      ->capture_default_str();
  app.add_option("--turbulence", c.turbulence_mps,
                 "Short gusts as ArduPilot's simulator makes them with this SIM_WIND_TURB, m/s")
      ->capture_default_str();
  app.add_option(
         "--fence-height", c.fence_height_m,
         "It keeps a fence: FENCE_ALT_MAX, m above home, and the polygon that it is given;\n"
         "beyond it returns (RTL). 0: FENCE_ENABLE is 0")
      ->capture_default_str();
  app.add_option("--seed", c.seed, "Of gusts and sensor noise")->capture_default_str();
  app.add_flag("--no-noise", t.no_noise, "Sensors without noise");
  app.add_option("--truth", a.truth_port,
                 "Sends what the aircraft really does, MAVLink's SIM_STATE 20 times a second, to\n"
                 "this UDP port of loopback")
      ->check(CLI::Range(1, 65535));
  app.add_option("--at", t.at,
                 "'SECONDS LINE': does what the line says on standard input, so long after the\n"
                 "start (with --hold-until: after that)");
}

}  // namespace

std::variant<FcArguments, int> parse_arguments(int argc, char** argv) {
  CLI::App app{kDescription};
  app.footer(kFooter);
  app.set_version_flag("--version", "skein-fc " + version());
  app.set_help_all_flag("--help-all", "The same of every command");
  FcArguments arguments;
  Texts texts;
  add_link_options(app, arguments, texts);
  add_flight_options(app, arguments, texts);
  if (const auto ends = command_line::read(app, argc, argv)) return *ends;
  EmulatorConfig& c = arguments.config;
  c.node_id = static_cast<std::uint8_t>(texts.node);
  c.companion_node = static_cast<std::uint8_t>(texts.companion);
  c.serial_id = static_cast<std::int8_t>(texts.serial);
  c.system_id = static_cast<std::uint8_t>(texts.system);
  c.companion_system = static_cast<std::uint8_t>(texts.companion_system.value_or(texts.system));
  c.airframe = airframe_named(texts.airframe);
  c.airspeed_mps = texts.speed_mps.value_or(c.airspeed_mps);
  set_defaults(app, c);
  c.origin = {texts.origin[0], texts.origin[1], texts.origin[2]};
  c.start = {texts.start[0], texts.start[1], heading_from_compass_deg(texts.heading_deg)};
  c.height_m = texts.start[2];
  c.wind_mps = -texts.wind_mps * unit_vector(heading_from_compass_deg(texts.wind_from_deg));
  c.noise = !texts.no_noise;
  if (!read_signing_key(texts.signing_key, c)) return command_line::kExitBadArguments;
  for (const std::string& text : texts.at) {
    const auto line = timed_line(text);
    if (!line) {
      std::fprintf(stderr, "skein-fc: --at '%s': it is 'SECONDS LINE', such as '30 mode RTL'\n",
                   text.c_str());
      return command_line::kExitBadArguments;
    }
    arguments.script.push_back(*line);
  }
  std::stable_sort(arguments.script.begin(), arguments.script.end(),
                   [](const TimedLine& a, const TimedLine& b) { return a.after < b.after; });
  if (const auto good = check(c); !good) {
    std::fprintf(stderr, "skein-fc: %s\n", good.error().message.c_str());
    return command_line::kExitBadArguments;
  }
  return arguments;
}

}  // namespace skein::hil
