// SPDX-License-Identifier: Apache-2.0
#include "skein/detectors/detector_socket.hpp"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "skein/detectors/detection_text.hpp"

namespace skein::detectors {
namespace {

constexpr int kUnreadableAtOnce = 16;
constexpr mode_t kPermissions = S_IRUSR | S_IWUSR | S_IRGRP | S_IWGRP;

Error trouble_at(const std::string& path, int error) {
  return Error{path + ": " + std::generic_category().message(error) +
               "; check detections.socket: its folder must exist and be writable"};
}

const sockaddr* as_address(const sockaddr_un& address) {
  return reinterpret_cast<const sockaddr*>(&address);  // how sockets are: NOLINT
}

/// A process that is gone has left the file: nobody takes what is sent there.
bool is_left_over(const sockaddr_un& address) {
  struct stat there {};
  // Nobody takes what is sent to any other file, either.
  if (::lstat(address.sun_path, &there) != 0 || !S_ISSOCK(there.st_mode)) return false;
  const int probe = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (probe < 0) return false;
  const bool refused =
      ::connect(probe, as_address(address), sizeof address) != 0 && errno == ECONNREFUSED;
  ::close(probe);
  return refused;
}

}  // namespace

Result<DetectorSocket> DetectorSocket::open(const std::string& path, const MissionOrigin& origin) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path) {
    return Error{"detections.socket has to be a path of 1 to 107 bytes"};
  }
  std::memcpy(address.sun_path, path.data(), path.size());
  const int descriptor = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return trouble_at(path, errno);
  if (is_left_over(address)) ::unlink(path.c_str());
  if (::bind(descriptor, as_address(address), sizeof address) != 0) {
    const int error = errno;
    ::close(descriptor);
    return trouble_at(path, error);
  }
  DetectorSocket made{descriptor, path, origin};
  if (::chmod(path.c_str(), kPermissions) != 0) return trouble_at(path, errno);
  return made;
}

DetectorSocket::DetectorSocket(DetectorSocket&& other) noexcept
    : descriptor_{std::exchange(other.descriptor_, -1)},
      path_{std::move(other.path_)},
      origin_{other.origin_},
      unreadable_{other.unreadable_},
      trouble_{std::move(other.trouble_)} {}

DetectorSocket::~DetectorSocket() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  ::unlink(path_.c_str());
}

std::optional<mission::Detection> DetectorSocket::poll() {
  std::array<char, kTextMax + 1> buffer{};
  for (int i = 0; i < kUnreadableAtOnce; ++i) {
    const ssize_t size = ::recv(descriptor_, buffer.data(), buffer.size(), 0);
    if (size < 0) return std::nullopt;
    auto detection = read_detection({buffer.data(), static_cast<std::size_t>(size)}, origin_);
    if (detection) return std::move(detection).value();
    ++unreadable_;
    trouble_ = detection.error().message;
  }
  return std::nullopt;  // the rest waits: nobody keeps the vehicle's agent busy with nonsense
}

std::optional<std::string> DetectorSocket::poll_trouble() { return std::exchange(trouble_, {}); }

}  // namespace skein::detectors
