// SPDX-License-Identifier: Apache-2.0
#include "skein/process/token.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <fstream>

namespace skein::process {
namespace {

constexpr std::size_t kTokenBytes = 16;

// Inlined, GCC 12 takes the text for a short one (-Wstringop-overread).
[[gnu::noinline]] bool is_token(std::string_view text) {
  return text.size() == 2 * kTokenBytes &&
         text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

}  // namespace

std::string make_token() {
  std::array<std::uint8_t, kTokenBytes> random{};
  // Of up to 256 bytes getrandom() gives all, or is interrupted before the first.
  while (::getrandom(random.data(), random.size(), 0) != static_cast<ssize_t>(random.size())) {
  }
  std::string token;
  for (const std::uint8_t byte : random) token += fmt::format("{:02x}", byte);
  return token;
}

Result<void> keep_token(const std::filesystem::path& file, std::string_view token) {
  const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (fd < 0) return Error{"cannot write " + file.string()};
  const std::string line = fmt::format("{}\n", token);
  const bool whole = ::write(fd, line.data(), line.size()) == static_cast<ssize_t>(line.size());
  if (::close(fd) != 0 || !whole) return Error{"cannot write " + file.string()};
  return {};
}

Result<std::string> read_or_make_token(const std::filesystem::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) {
    if (errno != ENOENT) return Error{"cannot read " + file.string()};
    std::string token = make_token();
    if (auto kept = keep_token(file, token); !kept) return kept.error();
    return token;
  }
  if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    return Error{
        fmt::format("{0}: others can read it; 'rm {0}', and a new one is made", file.string())};
  }
  std::string token;
  std::ifstream stream{file};
  std::getline(stream, token);
  if (!is_token(token)) {
    return Error{fmt::format("{0}: has no token in it; 'rm {0}', and one is made", file.string())};
  }
  return token;
}

}  // namespace skein::process
