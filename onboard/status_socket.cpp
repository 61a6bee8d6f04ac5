// SPDX-License-Identifier: Apache-2.0
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "skein/onboard/status.hpp"
#include "skein/system/descriptor.hpp"

namespace skein::onboard {
namespace {

using system::Descriptor;

constexpr int kWaiting = 8;
constexpr int kAnswersAtOnce = 8;  // so that a flood cannot keep the process from its watchdog
constexpr std::chrono::milliseconds kLeftOverWithin{500};
constexpr mode_t kMode = 0660;

std::optional<sockaddr_un> address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path) return std::nullopt;
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  return address;
}

const sockaddr* generic(const sockaddr_un& address) {
  return reinterpret_cast<const sockaddr*>(&address);
}

int new_socket(int more) { return ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | more, 0); }

/// A process that stands still has a queue, in which connect() waits.
std::optional<NoStatus> connect_to(const sockaddr_un& address, int socket,
                                   std::chrono::milliseconds at_most) {
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(at_most);
  timeval wait{};
  wait.tv_sec = whole.count();
  wait.tv_usec = std::chrono::microseconds{at_most - whole}.count();
  if (socket < 0 || ::setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &wait, sizeof wait) != 0) {
    return NoStatus::no_answer;
  }
  if (::connect(socket, generic(address), sizeof address) == 0) return std::nullopt;
  if (errno == ENOENT || errno == ECONNREFUSED) return NoStatus::nobody_there;
  return errno == EACCES ? NoStatus::not_allowed : NoStatus::no_answer;
}

bool is_left_over(const sockaddr_un& address) {
  struct stat there {};
  // Nobody takes a connection to any other file, either.
  if (::lstat(address.sun_path, &there) != 0 || !S_ISSOCK(there.st_mode)) return false;
  const Descriptor socket{new_socket(0)};
  return connect_to(address, socket.get(), kLeftOverWithin) == NoStatus::nobody_there;
}

}  // namespace

Result<std::unique_ptr<StatusSocket>> StatusSocket::open(const std::string& path) {
  const auto address = address_of(path);
  if (!address) return Error{path + ": longer than a socket's path may be; choose a shorter one"};
  if (is_left_over(*address)) ::unlink(path.c_str());
  Descriptor socket{new_socket(SOCK_NONBLOCK)};
  if (socket.get() < 0 || ::bind(socket.get(), generic(*address), sizeof *address) != 0 ||
      ::chmod(path.c_str(), kMode) != 0 || ::listen(socket.get(), kWaiting) != 0) {
    return Error{path + ": " + std::generic_category().message(errno) +
                 "; is its folder there, and no other process of this vehicle?"};
  }
  return std::unique_ptr<StatusSocket>{new StatusSocket{socket.release(), path}};
}

StatusSocket::~StatusSocket() {
  ::unlink(path_.c_str());
  ::close(descriptor_);
}

void StatusSocket::serve(const std::function<std::string()>& line) const {
  std::string text;
  for (int i = 0; i < kAnswersAtOnce; ++i) {
    const Descriptor asker{::accept4(descriptor_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK)};
    if (asker.get() < 0) return;
    if (text.empty()) text = line() + "\n";
    // It fits into the socket's buffer; who closes early gets nothing.
    (void)::send(asker.get(), text.data(), text.size(), MSG_NOSIGNAL);
  }
}

AskedStatus ask_status(const std::string& path, std::chrono::milliseconds at_most) {
  const auto address = address_of(path);
  if (!address) return {{}, NoStatus::nobody_there};
  const Descriptor socket{new_socket(0)};
  if (const auto failed = connect_to(*address, socket.get(), at_most)) return {{}, failed};
  std::string line;
  std::array<char, 4096> part{};
  pollfd readable{socket.get(), POLLIN, 0};
  const auto until = std::chrono::steady_clock::now() + at_most;
  while (line.find('\n') == std::string::npos) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        until - std::chrono::steady_clock::now());
    if (left.count() <= 0 || ::poll(&readable, 1, static_cast<int>(left.count())) < 1) break;
    const auto size = ::recv(socket.get(), part.data(), part.size(), 0);
    if (size <= 0) break;
    line.append(part.data(), static_cast<std::size_t>(size));
  }
  const auto end = line.find('\n');
  if (end == std::string::npos) return {{}, NoStatus::no_answer};
  line.resize(end);
  return {std::move(line), std::nullopt};
}

}  // namespace skein::onboard
