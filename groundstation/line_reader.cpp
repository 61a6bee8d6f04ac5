// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/line_reader.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <utility>

#include "skein/base/assert.hpp"
#include "skein/groundstation/prompt.hpp"

namespace skein::groundstation {

LineReader::LineReader(int file_descriptor, std::function<void()> on_line)
    : input_{file_descriptor}, stop_{eventfd(0, EFD_CLOEXEC)}, on_line_{std::move(on_line)} {
  SKEIN_ASSERT(stop_ >= 0);
  thread_ = std::thread{[this] { read_all(); }};
}

LineReader::~LineReader() {
  const std::uint64_t one = 1;
  SKEIN_ASSERT(write(stop_, &one, sizeof one) == sizeof one);
  thread_.join();
  close(stop_);
}

std::optional<std::string> LineReader::next() {
  const std::lock_guard lock{mutex_};
  return lines_.pop();
}

void LineReader::read_all() {
  std::array<pollfd, 2> watched{{{input_, POLLIN, 0}, {stop_, POLLIN, 0}}};
  std::array<char, 256> buffer{};
  while (true) {
    if (poll(watched.data(), watched.size(), -1) < 0) {
      if (errno == EINTR) continue;
      return;
    }
    if (watched[1].revents != 0) return;
    const auto size = read(input_, buffer.data(), buffer.size());
    if (size <= 0) return;
    take(buffer.data(), static_cast<std::size_t>(size));
  }
}

void LineReader::take(const char* data, std::size_t size) {
  bool complete = false;
  for (std::size_t i = 0; i < size; ++i) {
    if (data[i] != '\n') {
      if (partial_.size() <= kLineMax) partial_ += data[i];  // one more: it is refused
      continue;
    }
    const std::lock_guard lock{mutex_};
    lines_.push(std::exchange(partial_, {}));
    complete = true;
  }
  if (complete) on_line_();
}

}  // namespace skein::groundstation
