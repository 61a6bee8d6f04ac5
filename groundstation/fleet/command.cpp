// SPDX-License-Identifier: Apache-2.0
#include "command.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <system_error>
#include <utility>

#include "skein/system/descriptor.hpp"

namespace skein::fleet {
namespace {

using system::Descriptor;

using std::chrono::steady_clock;

Error failure(const std::string& what) {
  return Error{what + ": " + std::generic_category().message(errno)};
}

/// In memory, so that a command that does not read it ends nobody by a signal.
Result<Descriptor> input_file(std::string_view text) {
  Descriptor file{::memfd_create("skein-input", MFD_CLOEXEC)};
  if (!file) return failure("no memory for a command's input");
  while (!text.empty()) {
    const auto written = ::write(file.get(), text.data(), text.size());
    if (written < 0) return failure("no memory for a command's input");
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  ::lseek(file.get(), 0, SEEK_SET);
  return file;
}

struct Pipe {
  Descriptor reads;
  Descriptor writes;
};
Result<Pipe> make_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return failure("no pipe");
  return Pipe{Descriptor{ends[0]}, Descriptor{ends[1]}};
}

/// With these as its standard input, output and errors.
Result<pid_t> spawn(const std::vector<std::string>& command, int input, int output, int errors) {
  std::vector<std::string> words = command;
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (auto& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, errors, STDERR_FILENO);
  pid_t pid = -1;
  errno = ::posix_spawnp(&pid, pointers[0], &actions, nullptr, pointers.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (errno != 0) return failure(command[0] + ": cannot be started");
  return pid;
}

/// Appends what is there; false at the end.
bool take(Descriptor& from, std::string& text) {
  std::array<char, 65536> bytes{};
  const auto count = ::read(from.get(), bytes.data(), bytes.size());
  if (count > 0) text.append(bytes.data(), static_cast<std::size_t>(count));
  if (count < 0 && errno == EINTR) return true;
  if (count <= 0) from.reset();
  return count > 0;
}

/// Reads both until both end; false where that takes too long.
bool listen(Descriptor& output, Descriptor& errors, CommandOutcome& outcome,
            steady_clock::time_point deadline) {
  while (output || errors) {
    std::array<pollfd, 2> items{pollfd{output.get(), POLLIN, 0}, pollfd{errors.get(), POLLIN, 0}};
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - steady_clock::now());
    if (left.count() <= 0) return false;
    if (::poll(items.data(), items.size(), static_cast<int>(left.count())) <= 0) continue;
    if (items[0].revents != 0) {
      if (outcome.output.empty()) outcome.first_output = std::chrono::system_clock::now();
      take(output, outcome.output);
    }
    if (items[1].revents != 0) take(errors, outcome.errors);
  }
  return true;
}

int wait_for(pid_t pid) {
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) continue;
  constexpr int kSignal = 128;  // as shells count
  return WIFSIGNALED(status) ? kSignal + WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace

Result<CommandOutcome> run_command(const std::vector<std::string>& command, std::string_view input,
                                   std::chrono::milliseconds within,
                                   const std::filesystem::path& into) {
  const auto deadline = steady_clock::now() + within;
  auto in = input_file(input);
  if (!in) return in.error();
  auto errors = make_pipe();
  if (!errors) return errors.error();
  Pipe output;
  if (into.empty()) {
    auto made = make_pipe();
    if (!made) return made.error();
    output = std::move(made).value();
  } else {
    output.writes =
        Descriptor{::open(into.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)};
    if (!output.writes) return failure(into.string() + ": cannot be written");
  }
  const auto pid = spawn(command, in->get(), output.writes.get(), errors->writes.get());
  if (!pid) return pid.error();
  output.writes.reset();
  errors->writes.reset();
  CommandOutcome outcome;
  if (!listen(output.reads, errors->reads, outcome, deadline)) {
    ::kill(*pid, SIGKILL);
    (void)wait_for(*pid);
    return Error{"no answer within " +
                 std::to_string(std::chrono::duration_cast<std::chrono::seconds>(within).count()) +
                 " s"};
  }
  outcome.status = wait_for(*pid);
  return outcome;
}

}  // namespace skein::fleet
