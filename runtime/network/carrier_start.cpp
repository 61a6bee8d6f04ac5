// SPDX-License-Identifier: Apache-2.0
#include "carrier_start.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "confinement.hpp"

namespace skein::network {
namespace {

// As much as the machine allows: a burst waits there until it is read.
constexpr int kSocketBufferBytes = 1 << 20;

std::string message_of(int error) { return std::generic_category().message(error); }

/// What the new process has: nothing on its standard descriptors, no signal that is held back.
class Spawning {
 public:
  explicit Spawning(int socket) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    if (!kSanitized) {
      posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    }
    posix_spawn_file_actions_adddup2(&actions_, socket, kCarrierDescriptor);
    posix_spawnattr_init(&attributes_);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK);
  }
  ~Spawning() {
    posix_spawn_file_actions_destroy(&actions_);
    posix_spawnattr_destroy(&attributes_);
  }
  Spawning(const Spawning&) = delete;
  Spawning& operator=(const Spawning&) = delete;

  /// This program, as it was started: though a new release lies in its place by now.
  int start(pid_t& pid, VehicleId self) {
    std::string name{program_invocation_short_name};
    std::string argument{kCarrierArgument};
    std::string id = std::to_string(self.value);  // for people who look at the list of processes
    const std::array<char*, 4> words{name.data(), argument.data(), id.data(), nullptr};
    return posix_spawn(&pid, "/proc/self/exe", &actions_, &attributes_, words.data(), environ);
  }

 private:
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

std::string text_of(const siginfo_t& how) {
  if (how.si_code == CLD_EXITED) return "exit status " + std::to_string(how.si_status);
  const char* const meaning = sigdescr_np(how.si_status);
  return "signal " + std::to_string(how.si_status) +
         (meaning != nullptr ? std::string{" ("} + meaning + ")" : "");
}

}  // namespace

Result<CarrierChild> CarrierChild::start(VehicleId self) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return Error{"there is no socket to the network's process: " + message_of(errno)};
  }
  system::Descriptor ours{ends[0]};
  const system::Descriptor its{ends[1]};
  for (const int end : ends) {
    (void)setsockopt(end, SOL_SOCKET, SO_SNDBUF, &kSocketBufferBytes, sizeof kSocketBufferBytes);
  }
  pid_t pid = -1;
  Spawning spawning{its.get()};
  if (const int error = spawning.start(pid, self); error != 0) {
    return Error{"the network's process cannot be started: " + message_of(error)};
  }
  system::Descriptor ended{static_cast<int>(syscall(SYS_pidfd_open, pid, 0))};
  return CarrierChild{pid, std::move(ours), std::move(ended)};
}

std::chrono::nanoseconds CarrierChild::computed() const {
  clockid_t clock{};
  timespec time{};
  if (clock_getcpuclockid(pid_, &clock) != 0 || clock_gettime(clock, &time) != 0) return {};
  return std::chrono::seconds{time.tv_sec} + std::chrono::nanoseconds{time.tv_nsec};
}

std::optional<bool> CarrierChild::is_ready() const {
  std::error_code failed;
  bool seen = false;
  const std::filesystem::path threads{"/proc/" + std::to_string(pid_) + "/task"};
  for (std::filesystem::directory_iterator thread{threads, failed}, end; !failed && thread != end;
       thread.increment(failed)) {
    std::ifstream file{thread->path() / "stat"};
    std::string line;
    std::getline(file, line);
    const auto name_ends = line.rfind(") ");  // "7 (its name) S ..."
    if (name_ends == std::string::npos || name_ends + 2 >= line.size()) continue;
    seen = true;
    if (line[name_ends + 2] == 'R') return true;
  }
  return seen ? std::optional{false} : std::nullopt;
}

CarrierChild::~CarrierChild() { (void)end(); }

std::string CarrierChild::end() {
  if (pid_ < 0) return {};
  siginfo_t how{};
  const auto id = static_cast<id_t>(pid_);
  if (waitid(P_PID, id, &how, WEXITED | WNOHANG) == 0 && how.si_pid == 0) {
    kill(pid_, SIGKILL);
    while (waitid(P_PID, id, &how, WEXITED) != 0 && errno == EINTR) continue;
  }
  pid_ = -1;
  return text_of(how);
}

void CarrierChild::end_in_order(int milliseconds) {
  socket_.reset();
  pollfd item{ended_.get(), POLLIN, 0};
  if (item.fd >= 0) (void)poll(&item, 1, milliseconds);
  (void)end();
}

}  // namespace skein::network
