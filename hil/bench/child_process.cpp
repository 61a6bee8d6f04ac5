// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <system_error>
#include <utility>

namespace skein::hil {

Result<ChildProcess> ChildProcess::start(const std::vector<std::string>& argv,
                                         const std::filesystem::path& log,
                                         const std::map<std::string, std::string>& environment,
                                         int input, std::optional<std::size_t> file_bytes_max) {
  if (argv.empty() || ::access(argv[0].c_str(), X_OK) != 0) {
    return Error{(argv.empty() ? std::string{"an empty command"} : argv[0]) +
                 ": not an executable program; build it with ./dev build"};
  }
  const bool terminal = log.empty();
  const int output =
      terminal ? -1 : ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (!terminal && output < 0)
    return Error{log.string() + ": cannot be written: " + std::generic_category().message(errno)};
  const int nothing = terminal ? -1 : ::open("/dev/null", O_RDONLY | O_CLOEXEC);

  // Everything is made ready before the fork: the child may only call async-signal-safe functions.
  std::vector<std::string> variables;
  for (char** e = environ; *e != nullptr; ++e) {
    const std::string variable{*e};
    if (!environment.contains(variable.substr(0, variable.find('='))))
      variables.push_back(variable);
  }
  for (const auto& [name, value] : environment)
    variables.emplace_back(name).append("=").append(value);
  std::vector<char*> environment_pointers;
  environment_pointers.reserve(variables.size() + 1);
  for (auto& v : variables) environment_pointers.push_back(v.data());
  environment_pointers.push_back(nullptr);
  std::vector<std::string> words = argv;
  std::vector<char*> word_pointers;
  word_pointers.reserve(words.size() + 1);
  for (auto& w : words) word_pointers.push_back(w.data());
  word_pointers.push_back(nullptr);

  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  if (pid == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(127);  // the bench died before the line above
    // What is refused for a limit is an error then, and no end.
    ::signal(SIGXFSZ, SIG_IGN);
    if (file_bytes_max) {
      const rlimit limit{*file_bytes_max, *file_bytes_max};
      ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    if (!terminal) {
      ::setpgid(0, 0);  // Ctrl-C goes to the bench, which stops them in order
      ::dup2(input >= 0 ? input : nothing, STDIN_FILENO);
      ::dup2(output, STDOUT_FILENO);
      ::dup2(output, STDERR_FILENO);
    }
    ::execve(word_pointers[0], word_pointers.data(), environment_pointers.data());
    ::_exit(127);
  }
  if (output >= 0) ::close(output);
  if (nothing >= 0) ::close(nothing);
  if (pid < 0)
    return Error{argv[0] + ": cannot be started: " + std::generic_category().message(errno)};
  return ChildProcess{pid};
}

ChildProcess::~ChildProcess() { end_now(); }

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : pid_{std::exchange(other.pid_, -1)}, status_{other.status_} {}

ChildProcess& ChildProcess::operator=(ChildProcess&& other) noexcept {
  if (this != &other) {
    end_now();
    pid_ = std::exchange(other.pid_, -1);
    status_ = other.status_;
  }
  return *this;
}

void ChildProcess::end_now() {
  if (pid_ < 0 || ended()) return;
  signal(SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

std::optional<std::string> ChildProcess::ended() {
  if (!status_) {
    int status = 0;
    if (::waitpid(pid_, &status, WNOHANG) == pid_) status_ = status;
  }
  if (!status_) return std::nullopt;
  if (WIFSIGNALED(*status_)) {
    const int number = WTERMSIG(*status_);
    const char* const meaning = ::sigdescr_np(number);
    return "signal " + std::to_string(number) +
           (meaning != nullptr ? std::string{" ("} + meaning + ")" : "");
  }
  return "exit status " + std::to_string(WEXITSTATUS(*status_));
}

void ChildProcess::signal(int number) const {
  if (pid_ > 0 && !status_) ::kill(pid_, number);
}

void ChildProcess::signal_group(int number) const {
  if (pid_ > 0 && !status_ && ::kill(-pid_, number) != 0) ::kill(pid_, number);
}

void ChildProcess::limit_files(std::size_t bytes_max) const {
  const rlimit limit{bytes_max, bytes_max};
  if (pid_ > 0 && !status_) (void)::prlimit(pid_, RLIMIT_FSIZE, &limit, nullptr);
}

void ChildProcess::make_realtime() const {
  constexpr int kPriority = 70;  // above the threads of skein-onboard
  const sched_param parameters{.sched_priority = kPriority};
  if (pid_ > 0 && !status_) (void)::sched_setscheduler(pid_, SCHED_FIFO, &parameters);
}

bool ChildProcess::wait(std::chrono::milliseconds at_most) {
  if (ended()) return true;
  // A pid's file descriptor becomes readable when the process ends.
  const int descriptor = static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0));
  if (descriptor < 0) return ended().has_value();
  pollfd item{descriptor, POLLIN, 0};
  ::poll(&item, 1, static_cast<int>(at_most.count()));
  ::close(descriptor);
  return ended().has_value();
}

bool stop_all(const std::vector<ChildProcess*>& processes, std::chrono::milliseconds at_most) {
  for (auto* p : processes) p->signal(SIGTERM);
  const auto deadline = std::chrono::steady_clock::now() + at_most;
  bool clean = true;
  for (auto* p : processes) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        deadline - std::chrono::steady_clock::now());
    if (!p->wait(std::max(left, std::chrono::milliseconds{0}))) {
      p->signal(SIGKILL);
      (void)p->wait(std::chrono::seconds{2});
      clean = false;
    } else {
      clean = clean && p->clean();
    }
  }
  return clean;
}

}  // namespace skein::hil
