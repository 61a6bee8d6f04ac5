// SPDX-License-Identifier: Apache-2.0
#include "link_listener.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <system_error>
#include <utility>

#include "skein/base/time.hpp"

namespace skein::hil {
namespace {

constexpr std::chrono::seconds kEndWithin{5};

std::string state_of(const radio::Link& link) {
  if (!link.up) return "down";
  return fmt::format("up {:.3f} {:.3f} {:.6f}", 1e3 * to_seconds(link.delay),
                     1e3 * to_seconds(link.jitter), link.loss);
}

}  // namespace

Result<LinkListener> LinkListener::start(const std::string& command,
                                         const std::filesystem::path& log) {
  // A socket, which can be written to without waiting and without a signal where nobody reads.
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return Error{"no socket for --links: " + std::generic_category().message(errno)};
  }
  auto program = ChildProcess::start({"/bin/sh", "-c", command}, log, {}, ends[1]);
  ::close(ends[1]);
  if (!program) {
    ::close(ends[0]);
    return program.error();
  }
  return LinkListener{std::move(program).value(), ends[0]};
}

LinkListener::~LinkListener() { close(); }

LinkListener::LinkListener(LinkListener&& other) noexcept
    : program_{std::move(other.program_)},
      socket_{std::exchange(other.socket_, -1)},
      told_{std::move(other.told_)},
      waiting_{std::move(other.waiting_)},
      handing_{std::move(other.handing_)} {}

void LinkListener::tell(VehicleId from, VehicleId to, const radio::Link& link) {
  std::string state = state_of(link);
  std::string& told = told_[{from, to}];
  if (told == state) return;
  told = std::move(state);
  waiting_.insert({from, to});
}

void LinkListener::hand_on() {
  if (handing_.empty()) {
    for (const Ends& ends : std::exchange(waiting_, {})) {
      handing_ += fmt::format("{} {} {}\n", ends.first.value, ends.second.value, told_.at(ends));
    }
  }
  if (handing_.empty()) return;
  const auto sent = ::send(socket_, handing_.data(), handing_.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  if (sent > 0) handing_.erase(0, static_cast<std::size_t>(sent));
}

bool LinkListener::stop() {
  close();
  return program_.wait(kEndWithin);
}

void LinkListener::close() {
  if (socket_ >= 0) ::close(std::exchange(socket_, -1));
}

}  // namespace skein::hil
