// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <random>

#include "skein/configuration/ground_config.hpp"
#include "skein/configuration/routes_config.hpp"
#include "skein/configuration/vehicle_config.hpp"
#include "skein/hil/child_process.hpp"
#include "skein/network/node.hpp"
#include "skein/process/mission_network.hpp"
#include "skein/process/wake.hpp"
#include "skein/recording/reader.hpp"
#include "two_nodes.hpp"

namespace skein {
namespace {

using std::chrono::steady_clock;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

constexpr auto kPatience = std::chrono::seconds{60};  // a loaded machine, under a sanitizer
constexpr VehicleId kVehicle{7};

std::int64_t unix_ns_in(Duration d) {
  return std::chrono::duration_cast<Duration>(
             (std::chrono::system_clock::now() + d).time_since_epoch())
      .count();
}

/// Holds a UDP port of loopback.
class HeldPort {
 public:
  explicit HeldPort(std::uint16_t port) : socket_{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)} {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    held_ = ::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  ~HeldPort() { ::close(socket_); }
  HeldPort(const HeldPort&) = delete;
  HeldPort& operator=(const HeldPort&) = delete;
  [[nodiscard]] bool held() const { return held_; }

 private:
  int socket_;
  bool held_ = false;
};

/// A mission network of two, the folder for their files, and this test as one of the two nodes.
class Programs : public ::testing::Test {
 protected:
  Programs() {
    std::random_device device;
    folder_ =
        std::filesystem::temp_directory_path() / ("skein-programs-" + std::to_string(device()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] configuration::VehicleConfig vehicle() const {
    configuration::VehicleConfig config;
    config.time.epoch_unix_ns = unix_ns_in({});
    config.vehicle.id = kVehicle;
    config.vehicle.cruise_speed_mps = 50.0;
    config.vehicle.speed_min_mps = 40.0;
    config.vehicle.speed_max_mps = 60.0;
    config.vehicle.turn_radius_m = 100.0;
    config.vehicle.range_m = 40000.0;
    config.vehicle.capabilities.add(TaskKind::survey);
    config.vehicle.sensor_radius_m = 300.0;
    config.vehicle.height_m = 100.0;
    config.search = {{2000.0, 0.0}};
    config.network = nodes_.network_of(kVehicle);
    config.recording_folder = folder_ / "vehicle";
    return config;
  }
  [[nodiscard]] configuration::GroundConfig ground() const {
    configuration::GroundConfig config;
    config.time.epoch_unix_ns = unix_ns_in({});
    config.network = nodes_.network_of(kGroundStation);
    config.vehicles = {kVehicle};
    config.recording_folder = folder_ / "ground";
    return config;
  }

  [[nodiscard]] std::string write(const std::string& name, const std::string& text) const {
    std::ofstream{folder_ / name} << text;
    return folder_ / name;
  }
  [[nodiscard]] hil::ChildProcess start(const std::vector<std::string>& words) const {
    auto started = hil::ChildProcess::start(words, folder_ / "log", {});
    EXPECT_TRUE(started.ok());
    return std::move(started).value();
  }
  [[nodiscard]] std::string text_of(const std::string& name) const {
    std::ifstream file{folder_ / name};
    return {std::istreambuf_iterator<char>{file}, {}};
  }

  void open_node(VehicleId self) {
    const auto start = process::start_node(nodes_.network_of(self), self);
    ASSERT_TRUE(start.ok()) << start.error().message;
    auto opened = network::Node::open(
        process::node_config(nodes_.network_of(self), *start, [this] { wake_.notify(); }));
    ASSERT_TRUE(opened.ok()) << opened.error().message;
    node_ = std::move(opened).value();
  }

  /// The first message of that type that the node hears, within kPatience.
  template <class T>
  std::optional<T> hear(const std::function<void()>& meanwhile = [] {}) {
    const auto until = steady_clock::now() + kPatience;
    while (steady_clock::now() < until) {
      while (const auto received = node_->poll()) {
        if (const auto* wanted = std::get_if<T>(&received->message)) return *wanted;
      }
      meanwhile();
      wake_.wait_until(steady_clock::now() + std::chrono::milliseconds{200});
    }
    return std::nullopt;
  }

  std::filesystem::path folder_;
  TwoNodes nodes_{kVehicle};
  process::Wake wake_;
  std::unique_ptr<network::Node> node_;
};

TEST_F(Programs, AVehicleJoinsFliesAndStops) {
  open_node(kGroundStation);
  auto child = start({SKEIN_ONBOARD, "--config", write("v.yaml", to_yaml(vehicle()))});
  const auto first = hear<mission::Telemetry>();
  ASSERT_TRUE(first) << text_of("log");
  EXPECT_EQ(first->vehicle, kVehicle);
  std::optional<mission::Telemetry> later = first;
  while (later && later->state.distance_flown_m <= first->state.distance_flown_m) {
    later = hear<mission::Telemetry>();
  }
  EXPECT_TRUE(later) << "it does not fly";
  child.signal(SIGTERM);
  ASSERT_TRUE(child.wait(kPatience));
  EXPECT_EQ(child.ended(), "exit status 0");
  EXPECT_THAT(text_of("log"), ContainsRegex("SIGTERM: stopping"));
  EXPECT_THAT(text_of("log"), ContainsRegex("ended: [0-9]+ control periods, [0-9]+ overruns"));
  const auto recorded = recording::read(folder_ / "vehicle", kVehicle);
  ASSERT_TRUE(recorded.ok()) << recorded.error().message;
  EXPECT_FALSE(recorded->track.empty());
  EXPECT_FALSE(recorded->plans.empty());
}

/// What a service manager is sent (sd_notify(3)).
class NotifySocket {
 public:
  explicit NotifySocket(const std::filesystem::path& path)
      : socket_{::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)} {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.string().copy(address.sun_path, sizeof address.sun_path - 1);
    bound_ = ::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  ~NotifySocket() { ::close(socket_); }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;
  [[nodiscard]] bool bound() const { return bound_; }

  /// Whether that comes within kPatience.
  [[nodiscard]] bool hears(std::string_view wanted) const {
    const auto until = steady_clock::now() + kPatience;
    pollfd readable{socket_, POLLIN, 0};
    while (steady_clock::now() < until) {
      if (::poll(&readable, 1, 200) < 1) continue;
      std::array<char, 512> text{};
      const auto size = ::recv(socket_, text.data(), text.size(), 0);
      if (size > 0 && std::string_view{text.data(), static_cast<std::size_t>(size)} == wanted) {
        return true;
      }
    }
    return false;
  }

 private:
  int socket_;
  bool bound_ = false;
};

TEST_F(Programs, AVehicleTellsItsHostHowItIs) {
  const NotifySocket manager{folder_ / "notify"};
  ASSERT_TRUE(manager.bound());
  const std::string socket = folder_ / "status.sock";
  auto started = hil::ChildProcess::start(
      {SKEIN_ONBOARD, "--config", write("v.yaml", to_yaml(vehicle())), "--status-socket", socket},
      folder_ / "log", {{"NOTIFY_SOCKET", folder_ / "notify"}, {"WATCHDOG_USEC", "2000000"}});
  ASSERT_TRUE(started.ok());
  auto child = std::move(started).value();
  EXPECT_TRUE(manager.hears("READY=1"));
  EXPECT_TRUE(manager.hears("WATCHDOG=1"));
  auto flying = start({SKEIN_ONBOARD, "status", "--socket", socket, "--flying"});
  ASSERT_TRUE(flying.wait(kPatience));
  EXPECT_EQ(flying.ended(), "exit status 0") << text_of("log");
  auto text = start({SKEIN_ONBOARD, "status", "--socket", socket});
  ASSERT_TRUE(text.wait(kPatience));
  EXPECT_THAT(text_of("log"), HasSubstr("vehicle     7, "));
  child.signal(SIGTERM);
  ASSERT_TRUE(child.wait(kPatience));
  auto gone = start({SKEIN_ONBOARD, "status", "--socket", socket, "--flying"});
  ASSERT_TRUE(gone.wait(kPatience));
  EXPECT_EQ(gone.ended(), "exit status 3");
}

TEST_F(Programs, AVehicleWaitsForItsEpochOnTheNetwork) {
  open_node(kGroundStation);
  auto config = vehicle();
  config.time.epoch_unix_ns = unix_ns_in(std::chrono::hours{1});
  auto child = start({SKEIN_ONBOARD, "--config", write("v.yaml", to_yaml(config))});
  const auto telemetry = hear<mission::Telemetry>();
  ASSERT_TRUE(telemetry) << text_of("log");
  EXPECT_LT(telemetry->state.time, Instant{});
  EXPECT_EQ(telemetry->state.distance_flown_m, 0.0);
  EXPECT_EQ(telemetry->plan_number, 0U);
  child.signal(SIGINT);
  ASSERT_TRUE(child.wait(kPatience));
  EXPECT_EQ(child.ended(), "exit status 0");
}

TEST_F(Programs, TheGroundStationDecidesAsScripted) {
  open_node(kVehicle);
  auto config = ground();
  config.operator_decisions = {{.site = {3}, .grant = true, .reaction = Duration{}}};
  auto child = start({SKEIN_GROUND, "--config", write("g.yaml", to_yaml(config))});
  mission::AuthorisationRequest request;
  request.round = {{kVehicle, {1}, 4}, 2};
  request.site = {3};
  request.deliveries.push_back({{{{3}, TaskKind::deliver, 0}, kVehicle, at_seconds(3000.0)}, 0.0});
  request.decide_by = at_seconds(2000.0);
  const auto authorisation =
      hear<mission::Authorisation>([&] { node_->publish(mission::Message{request}); });
  ASSERT_TRUE(authorisation) << text_of("log");
  EXPECT_TRUE(authorisation->granted);
  EXPECT_EQ(authorisation->round, request.round);
  // Its input was at its end from the start: it runs without a terminal.
  EXPECT_FALSE(child.ended()) << text_of("log");
  child.signal(SIGTERM);
  ASSERT_TRUE(child.wait(kPatience));
  EXPECT_EQ(child.ended(), "exit status 0");
  EXPECT_THAT(text_of("log"), HasSubstr("ground station: authorised, site 3: by scenario"));
  const auto recorded = recording::read(folder_ / "ground", kGroundStation);
  ASSERT_TRUE(recorded.ok()) << recorded.error().message;
  const auto& events = recorded->events;
  EXPECT_TRUE(std::any_of(events.begin(), events.end(), [](const mission::MissionEvent& event) {
    return event.kind() == mission::EventKind::authorised;
  }));
}

TEST_F(Programs, WithoutAScriptTheGroundStationAsksAndNothingIsAuthorised) {
  open_node(kVehicle);
  auto child = start({SKEIN_GROUND, "--config", write("g.yaml", to_yaml(ground()))});
  mission::AuthorisationRequest request;
  request.round = {{kVehicle, {1}, 4}, 2};
  request.site = {3};
  request.deliveries.push_back({{{{3}, TaskKind::deliver, 0}, kVehicle, at_seconds(3000.0)}, 0.0});
  request.decide_by = at_seconds(2000.0);
  const auto until = steady_clock::now() + kPatience;
  while (text_of("log").find("authorise 3") == std::string::npos && steady_clock::now() < until) {
    node_->publish(mission::Message{request});
    wake_.wait_until(steady_clock::now() + std::chrono::milliseconds{200});
  }
  EXPECT_THAT(text_of("log"), HasSubstr("Authorisation wanted"));
  child.signal(SIGTERM);
  ASSERT_TRUE(child.wait(kPatience));
  while (const auto received = node_->poll()) {
    EXPECT_FALSE(std::holds_alternative<mission::Authorisation>(received->message));
  }
}

/// A team of one that knows of no site, and an operator at a shell.
class Told : public Programs {
 protected:
  static constexpr double kRate = 5.0;  // a mission of minutes

  void fly() {
    auto plane = vehicle();
    plane.vehicle.capabilities.add(TaskKind::deliver).add(TaskKind::assess);
    plane.vehicle.loads = 4;
    plane.vehicle.assess_radius_m = 300.0;
    plane.vehicle.final_approach_m = 200.0;
    plane.time.rate = kRate;
    plane.detections_socket = folder_ / "detections.sock";
    const auto station = station_of(plane);
    children_.push_back(start({SKEIN_GROUND, "--config", write("g.yaml", to_yaml(station))}));
    children_.push_back(start({SKEIN_ONBOARD, "--config", write("v.yaml", to_yaml(plane))}));
    ASSERT_TRUE(comes_to({"status"}, "searching")) << text_of("log");
  }
  /// Another vehicle besides, 1 km to the north.
  void fly_two() {
    constexpr VehicleId kOther{8};
    const std::uint16_t port = network::free_port_pairs(1).front();
    auto plane = vehicle();
    plane.time.rate = kRate;
    auto station = station_of(plane);
    auto other = plane;
    other.vehicle.id = kOther;
    other.vehicle.height_m = 150.0;
    other.start = {0.0, 1000.0, 0.0};
    other.search = {{2000.0, 1000.0}};
    other.recording_folder = folder_ / "other";
    other.network.port = port;
    other.network.peers.push_back({.id = kVehicle, .port = nodes_.vehicle_port()});
    plane.network.peers.push_back({.id = kOther, .port = port});
    station.network.peers.push_back({.id = kOther, .port = port});
    station.vehicles.push_back(kOther);
    children_.push_back(start({SKEIN_GROUND, "--config", write("g.yaml", to_yaml(station))}));
    children_.push_back(start({SKEIN_ONBOARD, "--config", write("v.yaml", to_yaml(plane))}));
    children_.push_back(start({SKEIN_ONBOARD, "--config", write("o.yaml", to_yaml(other))}));
    ASSERT_TRUE(comes_to({"status"}, "7  searching")) << text_of("log");
    ASSERT_TRUE(comes_to({"status"}, "8  searching")) << text_of("log");
  }
  [[nodiscard]] configuration::GroundConfig station_of(
      const configuration::VehicleConfig& plane) const {
    auto station = ground();
    station.time = plane.time;
    station.origin = plane.origin;
    station.console.port = 0;
    station.control_socket = "skein-told-" + std::to_string(nodes_.ground_port());
    return station;
  }
  /// Whether the answer to that line comes to have those words.
  bool comes_to(const std::vector<std::string>& line, const std::string& words) {
    const auto until = steady_clock::now() + kPatience;
    while (steady_clock::now() < until) {
      if (tell(line).find(words) != std::string::npos) return true;
      wake_.wait_until(steady_clock::now() + std::chrono::milliseconds{200});
    }
    return false;
  }
  std::string tell(const std::vector<std::string>& line) {
    std::vector<std::string> words{SKEIN_GROUND, "tell", "--config", folder_ / "g.yaml"};
    words.insert(words.end(), line.begin(), line.end());
    std::filesystem::remove(folder_ / "answer");
    auto child = hil::ChildProcess::start(words, folder_ / "answer", {});
    EXPECT_TRUE(child.ok() && child->wait(kPatience));
    return text_of("answer");
  }
  void TearDown() override {
    for (auto& child : children_) child.signal(SIGTERM);
    for (auto& child : children_) EXPECT_TRUE(child.wait(kPatience));
    Programs::TearDown();
  }
  static std::string number_in(const std::string& answer) {
    const auto at = answer.find("site 1");
    return at == std::string::npos ? answer : answer.substr(at + 5, 5);
  }

  std::vector<hil::ChildProcess> children_;
};

TEST_F(Told, ASiteOfTheOperatorIsSurveyedAndDeliveredTo) {
  fly();
  const std::string answer = tell({"site", "1500", "600", "deliver", "090", "reward", "3"});
  EXPECT_THAT(answer, HasSubstr("told to vehicle 7"));
  const std::string site = number_in(answer);
  ASSERT_TRUE(comes_to({"pending"}, "authorise " + site)) << tell({"sites"}) << text_of("log");
  EXPECT_THAT(tell({"authorise", site}), HasSubstr("done"));
  EXPECT_TRUE(comes_to({"sites"}, "1 delivered")) << tell({"sites"}) << text_of("log");
  EXPECT_THAT(tell({"withdraw", "site", site}), HasSubstr("nothing is left of it"));
}

TEST_F(Told, WhatADetectorSeesIsProposedTakenAndCanBeWithdrawn) {
  fly();
  // 1 km north and 2.2 km east of the origin.
  const std::string example = SKEIN_SOURCE_DIR "/onboard/detectors/example/detector.py";
  auto detector = start(
      {"/usr/bin/env", "python3", example, folder_ / "detections.sock", "flood", "0.009", "0.02"});
  ASSERT_TRUE(detector.wait(kPatience));
  ASSERT_EQ(detector.ended(), "exit status 0") << text_of("log");
  ASSERT_TRUE(comes_to({"proposals"}, "proposal 1: flood")) << text_of("log");
  const std::string site = number_in(tell({"accept", "1"}));
  EXPECT_TRUE(comes_to({"sites"}, "told to vehicle 7")) << tell({"sites"});
  EXPECT_TRUE(comes_to({"status"}, "surveying")) << text_of("log");
  EXPECT_THAT(tell({"withdraw", "site", site}), HasSubstr("is withdrawn"));
  EXPECT_TRUE(comes_to({"status"}, "searching")) << tell({"status"});
  EXPECT_THAT(tell({"hazard", "0", "5000", "100"}), HasSubstr("is told to all"));
}

/// From 1.5 km north of where the vehicles circle: first to the east.
std::string plan_of_two(double turn_radius_m) {
  configuration::RoutePlan plan;
  plan.title = "two";
  plan.site = {5000.0, 3500.0};
  plan.arrival_s = plan.bound_s = 60.0;
  for (const std::uint16_t id : {std::uint16_t{7}, std::uint16_t{8}}) {
    const double north_m = id == 7 ? 1500.0 : 2500.0;
    configuration::VehicleRoute one;
    one.vehicle = {id};
    one.route = {{{2000.0, north_m}, {4000.0, north_m}, {5000.0, 3500.0}}, turn_radius_m, 50.0};
    one.length_m = one.bound_m = 3000.0;
    one.arrival_s = 60.0;
    plan.routes.push_back(one);
  }
  return to_yaml(plan);
}

TEST_F(Told, RoutesReachVehiclesThatStartedWithoutAndAreFlownByAllOrNone) {
  fly_two();
  // Tighter than the vehicles' paths are planned, which only they know.
  const std::string tight = write("tight.yaml", plan_of_two(40.0));
  EXPECT_THAT(tell({"routes", tight, "in", "60"}), HasSubstr("is offered to 2 vehicles"));
  EXPECT_TRUE(comes_to({"status"}, "called off")) << tell({"status"}) << text_of("log");
  EXPECT_THAT(tell({"routes"}), HasSubstr("refused: its arcs are tighter"));
  EXPECT_THAT(text_of("log"), HasSubstr("does not fly its own"));

  const std::string plan = write("plan.yaml", plan_of_two(150.0));
  EXPECT_THAT(tell({"routes", plan}), HasSubstr("begins too soon"));
  EXPECT_THAT(tell({"preview", "routes", plan, "in", "60"}), HasSubstr("judge turns"));
  EXPECT_THAT(tell({"routes", plan, "in", "60"}), HasSubstr("is offered to 2 vehicles"));
  EXPECT_TRUE(comes_to({"status"}, "taken by all")) << tell({"status"}) << text_of("log");
  EXPECT_TRUE(comes_to({"status"}, "7  en route")) << tell({"status"});
  EXPECT_TRUE(comes_to({"status"}, "8  en route")) << tell({"status"});
  EXPECT_TRUE(comes_to({"routes"}, "7  flown")) << tell({"routes"}) << text_of("log");
  EXPECT_TRUE(comes_to({"routes"}, "8  flown")) << tell({"routes"}) << text_of("log");
}

struct BadStart {
  const char* name;
  std::vector<std::string> words;
  int status;
  const char* says;
};

class BadStarts : public Programs, public ::testing::WithParamInterface<BadStart> {};

TEST_P(BadStarts, EndWithASentence) {
  (void)write("bad.yaml", "version: 1\nvehicles: [1]\nspede_mps: 3\n");
  auto config = vehicle();
  config.recording_folder = "/dev/null/nowhere";
  (void)write("no-recording.yaml", to_yaml(config));
  std::vector<std::string> words = GetParam().words;
  for (auto& word : words) {
    if (word.ends_with(".yaml")) word = folder_ / word;  // an absolute path stays itself
  }
  auto child = start(words);
  ASSERT_TRUE(child.wait(kPatience));
  EXPECT_EQ(child.ended(), "exit status " + std::to_string(GetParam().status));
  EXPECT_THAT(text_of("log"), HasSubstr(GetParam().says));
}

INSTANTIATE_TEST_SUITE_P(
    Programs, BadStarts,
    ::testing::Values(
        BadStart{"onboard_no_arguments", {SKEIN_ONBOARD}, 2, "--config is required"},
        BadStart{"onboard_no_file", {SKEIN_ONBOARD, "--config", "x.yaml"}, 2, "cannot be opened"},
        BadStart{"onboard_bad_key", {SKEIN_ONBOARD, "--config", "bad.yaml"}, 2, "spede_mps"},
        BadStart{"onboard_no_recording",
                 {SKEIN_ONBOARD, "--config", "no-recording.yaml"},
                 3,
                 "cannot record"},
        BadStart{"onboard_no_such_command",
                 {SKEIN_ONBOARD, "keys", "delete"},
                 2,
                 "delete: there is no such command"},
        BadStart{"onboard_a_word_too_many",
                 {SKEIN_ONBOARD, "check", "x.yaml"},
                 2,
                 "--config is required"},
        BadStart{"ground_no_such_option",
                 {SKEIN_GROUND, "keys", "show", "--foo"},
                 2,
                 "not expected: --foo"},
        BadStart{"ground_no_file", {SKEIN_GROUND, "--config", "x.yaml"}, 2, "cannot be opened"},
        BadStart{"ground_bad_key", {SKEIN_GROUND, "--config", "bad.yaml"}, 2, "spede_mps"},
        BadStart{"plan_no_file", {SKEIN_GROUND, "plan", "x.yaml"}, 2, "cannot be opened"},
        BadStart{"plan_no_routes",
                 {SKEIN_GROUND, "plan", SKEIN_SOURCE_DIR "/scenarios/coalition-6.yaml"},
                 1,
                 "plans no routes"},
        BadStart{"tell_nobody",
                 {SKEIN_GROUND, "tell", "--socket", "skein-nobody", "status"},
                 3,
                 "no ground station has the control socket"}),
    [](const auto& param_info) { return param_info.param.name; });

TEST_F(Programs, TheirHelpIsText) {
  for (const char* program : {SKEIN_ONBOARD, SKEIN_GROUND}) {
    auto helped = start({program, "--help-all"});
    ASSERT_TRUE(helped.wait(kPatience) && helped.clean());
    const std::string text = text_of("log");
    EXPECT_GT(text.size(), 500U);
    for (const char c : text) ASSERT_TRUE(c == '\n' || (c >= ' ' && c <= '~')) << int{c};
  }
}

TEST_F(Programs, APortInUseIsNamed) {
  const HeldPort held{nodes_.vehicle_port()};
  ASSERT_TRUE(held.held());
  auto child = start({SKEIN_ONBOARD, "--config", write("v.yaml", to_yaml(vehicle()))});
  ASSERT_TRUE(child.wait(kPatience));
  EXPECT_EQ(child.ended(), "exit status 3");
  EXPECT_THAT(text_of("log"), HasSubstr("cannot join the mission network"));
  EXPECT_THAT(text_of("log"), HasSubstr(std::to_string(nodes_.vehicle_port())));
}

}  // namespace
}  // namespace skein
