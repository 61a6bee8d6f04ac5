// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "check_makers.hpp"
#include "skein/configuration/routes_config.hpp"
#include "skein/identity/identity.hpp"
#include "skein/mission/host_watch.hpp"
#include "skein/onboard/status.hpp"
#include "skein/onboard/threads.hpp"
#include "skein/planning/fence_check.hpp"
#include "skein/process/host.hpp"
#include "skein/process/mission_network.hpp"
#include "skein/system/descriptor.hpp"

namespace skein::onboard {
namespace {

using system::Descriptor;

namespace fs = std::filesystem;

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kDay_s = 86'400;
constexpr std::int64_t kEpochSoon_s = 3'600;
constexpr std::int64_t kEpochOld_s = 7 * kDay_s;
constexpr std::int64_t kKeysSoon_s = kDay_s;
constexpr std::uint64_t kMega = 1'000'000;
constexpr std::uint64_t kMemoryMin = 256 * kMega;  ///< twice what a process of a large team takes
constexpr std::chrono::milliseconds kStatusWithin{500};

std::string said(int error) { return std::generic_category().message(error); }

// --- time --------------------------------------------------------------------------------------

Check check_clock(bool among_machines) {
  const auto clock = process::clock_state();
  const char* const remedy = "start chrony, or whatever sets this machine's clock";
  if (!clock) return warn("clock", "the kernel does not say", remedy);
  if (clock->synchronised && clock->error_max <= mission::kClockErrorMax) {
    return ok("clock", fmt::format("synchronised to {:.3f} s",
                                   std::chrono::duration<double>(clock->error_max).count()));
  }
  if (!among_machines) {
    return warn("clock", "not synchronised", "it matters once other machines are in the team");
  }
  return fail("clock", "not synchronised", remedy);
}

Check check_time_source() {
  std::error_code failed;
  static constexpr std::array<std::pair<const char*, const char*>, 4> kSources{{
      {"/run/chrony/chronyd.pid", "chrony"},
      {"/run/chronyd.pid", "chrony"},
      {"/run/systemd/timesync/synchronized", "systemd-timesyncd"},
      {"/run/ntpd.pid", "ntpd"},
  }};
  const bool pulse = fs::exists("/dev/pps0", failed);
  for (const auto& [file, name] : kSources) {
    if (fs::exists(file, failed)) {
      return ok("time source", std::string{name} + (pulse ? ", pulse per second" : ""));
    }
  }
  return warn("time source", "none of chrony, systemd-timesyncd, ntpd runs",
              "in the field a GNSS receiver or one machine of the team gives the time "
              "(docs/field-guide.md)");
}

// --- files -------------------------------------------------------------------------------------

/// The folder, or the nearest above it that is there: it is made at the start.
fs::path existing(fs::path folder) {
  std::error_code failed;
  folder = fs::absolute(folder, failed);
  while (!fs::exists(folder, failed) && folder.has_parent_path() &&
         folder != folder.parent_path()) {
    folder = folder.parent_path();
  }
  return folder;
}

Check check_writable(const std::string& what, const fs::path& folder) {
  const fs::path there = existing(folder);
  std::error_code failed;
  if (!fs::is_directory(there, failed)) {
    return fail(what, there.string() + " is no folder", "name another, or move that file away");
  }
  if (::access(there.c_str(), W_OK | X_OK) != 0) {
    return fail(what, fmt::format("{}: {}", there.string(), said(errno)),
                "as the user of the service: 'chown skein', or name another folder");
  }
  return ok(what, there == folder ? folder.string() : folder.string() + ", to be made");
}

void check_recording(Checks& all, const configuration::VehicleConfig& config) {
  if (config.recording_folder.empty()) {
    all.push_back(warn("recording", "none", "recording_folder keeps what happened"));
    all.push_back(ok("disk", "not needed"));
    return;
  }
  all.push_back(check_writable("recording", config.recording_folder));
  const auto free = process::free_bytes(existing(config.recording_folder));
  const std::uint64_t limit = config.recording_limit_mb * kMega;
  if (!free) {
    all.push_back(warn("disk", "its file system does not say", "see 'df'"));
  } else if (*free < mission::kDiskFreeMinBytes) {
    all.push_back(
        fail("disk", fmt::format("{} MB free", *free / kMega),
             fmt::format("make room: {} MB at least", mission::kDiskFreeMinBytes / kMega)));
  } else if (*free < limit) {
    all.push_back(
        warn("disk", fmt::format("{} MB free", *free / kMega),
             fmt::format("a recording may take {} MB (recording_limit_mb)", limit / kMega)));
  } else {
    all.push_back(ok("disk", fmt::format("{} MB free", *free / kMega)));
  }
}

Check check_detectors(const std::string& socket) {
  if (socket.empty()) return ok("detectors", "none are listened to");
  const fs::path folder = fs::path{socket}.parent_path();
  std::error_code failed;
  if (!fs::is_directory(folder, failed)) {
    return fail("detectors", folder.string() + " is not there",
                "make it, or mend the socket's path in the configuration");
  }
  return check_writable("detectors", folder);
}

// --- keys --------------------------------------------------------------------------------------

void check_keys(Checks& all, const configuration::VehicleConfig& config, std::int64_t now_unix_s) {
  const std::string& folder = config.network.keys;
  if (folder.empty()) {
    const auto starts = process::check_start(config.network, config.vehicle.id);
    all.push_back(starts ? ok("keys", "none, on this machine alone")
                         : fail("keys", "none", starts.error().message));
    return;
  }
  const auto keys = identity::KeyFolder::of(folder);
  const auto key = identity::read_node_key(keys);
  all.push_back(key ? ok("keys", "readable, for nobody else: " + folder)
                    : fail("keys", "no good", key.error().message));
  const auto membership = identity::read_membership(keys);
  if (!membership) {
    all.push_back(fail("certificate", "none", membership.error().message));
    return;
  }
  const auto& own = membership->own;
  all.push_back(own.node == config.vehicle.id
                    ? ok("certificate", fmt::format("of vehicle {}, mission {}", own.node.value,
                                                    membership->authority.name))
                    : fail("certificate", fmt::format("of vehicle {}", own.node.value),
                           fmt::format("this is vehicle {}: give it a folder of its own, or enrol "
                                       "it (docs/keys.md)",
                                       config.vehicle.id.value)));
  const std::int64_t left = own.not_after_unix_s - now_unix_s;
  const std::string until = "until " + identity::utc_text(own.not_after_unix_s);
  const char* const remedy = "enrol it again (docs/keys.md)";
  if (left <= 0) {
    all.push_back(fail("certificate's end", until + ", which is over", remedy));
  } else if (left < kKeysSoon_s) {
    all.push_back(warn("certificate's end", until, remedy));
  } else {
    all.push_back(ok("certificate's end", until));
  }
  const auto opened = identity::Identity::open(keys, now_unix_s);
  all.push_back(opened ? ok("membership", "good now")
                       : fail("membership", "no good", opened.error().message));
}

// --- network -----------------------------------------------------------------------------------

sockaddr_in address_of(const std::string& ip, std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  ::inet_pton(AF_INET, ip.c_str(), &address.sin_addr);
  return address;
}
const sockaddr* generic(const sockaddr_in& address) {
  return reinterpret_cast<const sockaddr*>(&address);
}

struct Interface {
  std::string name;
  bool is_up = false;
  bool multicast = false;
};
std::optional<Interface> interface_with(const std::string& ip) {
  const in_addr wanted = address_of(ip, 0).sin_addr;
  ifaddrs* first = nullptr;
  if (::getifaddrs(&first) != 0) return std::nullopt;
  std::optional<Interface> found;
  for (const ifaddrs* i = first; i != nullptr && !found; i = i->ifa_next) {
    if (i->ifa_addr == nullptr || i->ifa_addr->sa_family != AF_INET) continue;
    const auto* const own = reinterpret_cast<const sockaddr_in*>(i->ifa_addr);
    const bool loops = (i->ifa_flags & IFF_LOOPBACK) != 0 && ip.starts_with("127.");
    if (own->sin_addr.s_addr != wanted.s_addr && !loops) continue;
    found =
        Interface{i->ifa_name, (i->ifa_flags & IFF_UP) != 0 && (i->ifa_flags & IFF_RUNNING) != 0,
                  (i->ifa_flags & IFF_MULTICAST) != 0};
  }
  ::freeifaddrs(first);
  return found;
}

/// Whether the kernel knows a way there from our address.
Check check_route(const std::string& what, const std::string& from, const std::string& to,
                  std::uint16_t port) {
  const Descriptor socket{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  constexpr int kOn = 1;
  (void)::setsockopt(socket.get(), SOL_SOCKET, SO_BROADCAST, &kOn, sizeof kOn);
  const sockaddr_in own = address_of(from, 0);
  const in_addr interface = own.sin_addr;
  (void)::setsockopt(socket.get(), IPPROTO_IP, IP_MULTICAST_IF, &interface, sizeof interface);
  const sockaddr_in other = address_of(to, port);
  if (::bind(socket.get(), generic(own), sizeof own) == 0 &&
      ::connect(socket.get(), generic(other), sizeof other) == 0) {
    return ok(what, fmt::format("{} from {}", to, from));
  }
  return fail(what, fmt::format("{} from {}: {}", to, from, said(errno)),
              fmt::format("'ip route add {} dev INTERFACE', or mend network.address", to));
}

Check check_port(const configuration::NetworkConfig& network) {
  const bool air = network.peers.empty();
  const Descriptor socket{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  if (air) {  // all have the same one, on one machine too
    constexpr int kOn = 1;
    (void)::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &kOn, sizeof kOn);
  }
  const std::string& address = air ? network.air.group : network.address;
  const sockaddr_in own = address_of(address, network.port);
  const std::string found = fmt::format("{}:{}", address, network.port);
  if (::bind(socket.get(), generic(own), sizeof own) == 0) return ok("port", found + " is free");
  if (errno == EADDRINUSE) {
    return fail("port", found + " is taken",
                fmt::format("end the process that has it ('ss -ulpn sport = :{}'), or choose "
                            "another network.port",
                            network.port));
  }
  return fail("port", found + ": " + said(errno),
              air ? "mend network.air.group" : "mend network.address");
}

void check_network(Checks& all, const configuration::NetworkConfig& network) {
  const auto interface = interface_with(network.address);
  if (!interface) {
    all.push_back(fail("network interface", network.address + " is no address of this machine",
                       "see 'ip -4 address'; set network.address, or the interface's address"));
  } else if (!interface->is_up) {
    all.push_back(fail("network interface", interface->name + " is not up or has no link",
                       fmt::format("'ip link set {} up'; is its radio on?", interface->name)));
  } else {
    all.push_back(
        ok("network interface", fmt::format("{} ({})", interface->name, network.address)));
  }
  if (!network.peers.empty()) {
    all.push_back(ok("group", fmt::format("none: {} peers, each by itself", network.peers.size())));
    for (const auto& peer : network.peers) {
      if (peer.address == network.address) continue;
      all.push_back(check_route(fmt::format("route to node {}", peer.id.value), network.address,
                                peer.address, peer.port));
    }
  } else {
    const std::string& group = network.air.group;
    const bool multicast = IN_MULTICAST(ntohl(address_of(group, 0).sin_addr.s_addr));
    const bool loops = interface && network.address.starts_with("127.");
    all.push_back(multicast && interface && !interface->multicast && !loops
                      ? fail("group",
                             fmt::format("{}: {} takes no multicast", group, interface->name),
                             fmt::format("'ip link set {} multicast on', or name its broadcast "
                                         "address as air.group",
                                         interface->name))
                      : ok("group", group));
    all.push_back(check_route("route to the group", network.address, group, network.port));
  }
  std::error_code failed;
  if (!network.transport_plugin.empty()) {
    all.push_back(fs::exists(network.transport_plugin, failed)
                      ? ok("transport plugin", network.transport_plugin)
                      : fail("transport plugin", network.transport_plugin + " is not there",
                             "mend network.transport_plugin"));
  }
}

// --- the machine -------------------------------------------------------------------------------

Check check_other_process(const configuration::VehicleConfig& config) {
  const std::string socket = status_socket_of(config.vehicle.id);
  const auto asked = ask_status(socket, kStatusWithin);
  if (asked.failed != NoStatus::nobody_there) {
    return fail("other skein-onboard", "this vehicle's runs already: " + socket,
                fmt::format("'skein-onboard status' shows it; 'systemctl stop skein-onboard@{}' "
                            "before another is started",
                            config.vehicle.id.value));
  }
  std::string others;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator{"/proc", failed}) {
    const std::string pid = entry.path().filename();
    if (pid.find_first_not_of("0123456789") != std::string::npos) continue;
    std::string name;
    std::getline(std::ifstream{entry.path() / "comm"}, name);
    if (name == "skein-onboard" && pid != std::to_string(::getpid())) {
      others += (others.empty() ? "" : ", ") + pid;
    }
  }
  if (others.empty()) return ok("other skein-onboard", "none runs");
  return warn("other skein-onboard", "runs: process " + others,
              "fine for other vehicles of this machine; of this one there may be only one");
}

Check check_realtime() {
  int wanted = 0;
  for (const ThreadSpec& spec : kThreads) wanted = std::max(wanted, spec.priority);
  std::thread thread{[] {}};
  sched_param parameters{};
  parameters.sched_priority = wanted;
  const int failure = ::pthread_setschedparam(thread.native_handle(), SCHED_FIFO, &parameters);
  thread.join();
  if (failure == 0) return ok("real-time priority", fmt::format("{} is permitted", wanted));
  return warn("real-time priority", said(failure),
              fmt::format("the service has it (LimitRTPRIO={0}); for others 'ulimit -r {0}' or "
                          "CAP_SYS_NICE",
                          wanted));
}

Check check_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  const int count = ::sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
  if (count >= 2) return ok("cores", fmt::format("{}", count));
  return warn("cores", "1", "two keep planning away from control");
}

Check check_memory() {
  std::uint64_t available = UINT64_MAX;
  std::ifstream file{"/proc/meminfo"};
  for (std::string key; file >> key;) {
    if (key == "MemAvailable:") {
      std::uint64_t kib = 0;
      if (file >> kib) available = kib * 1024;
    }
  }
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    available = std::min<std::uint64_t>(available, limit.rlim_cur);
  }
  if (available == UINT64_MAX) return ok("memory", "the kernel does not say");
  const std::string found = fmt::format("{} MB available", available / kMega);
  if (available >= kMemoryMin) return ok("memory", found);
  return fail("memory", found,
              fmt::format("{} MB are needed: end other programs, or raise the limit (ulimit -v, "
                          "MemoryMax)",
                          kMemoryMin / kMega));
}

Check check_core_files() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_CORE, &limit) == 0 && limit.rlim_cur == 0) {
    return ok("core files", "none are written");
  }
  return warn("core files", "may be written",
              "with keys in them: the service has LimitCORE=0; for others 'ulimit -c 0'");
}

/// Planned turns are wider in wind.
Check check_search(const configuration::VehicleConfig& config) {
  constexpr double kInWind = 1.5;
  const double radius_m = kInWind * config.vehicle.planning_radius_m();
  for (const Vec2& point : config.search) {
    if (planning::orbit_leads_over(config.fence, point, radius_m)) continue;
    return warn("search",
                fmt::format("{} lies in a narrow part of the fence", planning::place_text(point)),
                fmt::format("where wind widens the turns to {:.0f} m it is left out; move it, or "
                            "widen fence.corners",
                            radius_m));
  }
  return ok("search", fmt::format("{} points", config.search.size()));
}

}  // namespace

Check check_epoch(const configuration::TimeConfig& time, std::int64_t now_unix_ns) {
  const std::int64_t since_s = (now_unix_ns - time.epoch_unix_ns) / kSecond_ns;
  const char* const remedy =
      "time.epoch_unix_ns is the mission's, the same on all machines; is the clock "
      "right?";
  if (since_s < -kEpochSoon_s) {
    return warn("epoch", fmt::format("the mission begins in {} h", -since_s / 3600), remedy);
  }
  if (since_s < 0) return ok("epoch", fmt::format("the mission begins in {} s", -since_s));
  if (since_s > kEpochOld_s) {
    return warn("epoch", fmt::format("the mission began {} days ago", since_s / kDay_s), remedy);
  }
  return ok("epoch", fmt::format("the mission began {} s ago", since_s));
}

Checks check_host(const configuration::VehicleConfig& config, std::int64_t now_unix_ns) {
  Checks all = check_host_of_running(config, now_unix_ns);
  append(all, in_group(CheckGroup::network, {check_port(config.network)}));
  append(all, in_group(CheckGroup::computer, {check_other_process(config)}));
  return all;
}

Checks check_host_of_running(const configuration::VehicleConfig& config, std::int64_t now_unix_ns) {
  const auto route = configuration::timed_path(config.route, config.vehicle);
  Checks all{ok("configuration", fmt::format("good, vehicle {}", config.vehicle.id.value)),
             route ? ok("route", config.route.waypoints.empty() ? "none" : "can be flown")
                   : fail("route", "cannot be flown", route.error().message),
             check_search(config)};
  append(all, in_group(CheckGroup::clock, {check_epoch(config.time, now_unix_ns),
                                           check_clock(process::among_machines(config.network)),
                                           check_time_source()}));
  Checks storage;
  check_recording(storage, config);
  storage.push_back(check_detectors(config.detections_socket));
  append(all, in_group(CheckGroup::storage, std::move(storage)));
  Checks keys;
  check_keys(keys, config, now_unix_ns / kSecond_ns);
  append(all, in_group(CheckGroup::keys, std::move(keys)));
  Checks network;
  check_network(network, config.network);
  append(all, in_group(CheckGroup::network, std::move(network)));
  append(all, in_group(CheckGroup::computer,
                       {check_realtime(), check_cores(), check_memory(), check_core_files()}));
  return all;
}

}  // namespace skein::onboard
