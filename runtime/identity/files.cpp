// SPDX-License-Identifier: Apache-2.0
#include "files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>
#include <thread>
#include <utility>

#include "skein/system/descriptor.hpp"

namespace skein::identity {
namespace {

using system::Descriptor;

constexpr mode_t kOthers = 077;
constexpr std::chrono::milliseconds kLookAgain{10};

/// What the kernel last said.
std::string said() { return std::generic_category().message(errno); }

Error cannot(const char* what, const std::filesystem::path& path) {
  return Error{fmt::format("cannot {} {}: {}", what, path.string(), said())};
}

/// So that a service that runs as another user reads what root made for it.
bool give_to_owner_of(const std::filesystem::path& folder, int descriptor) {
  struct stat above {};
  if (::geteuid() != 0) return true;
  return ::stat(folder.c_str(), &above) == 0 &&
         ::fchown(descriptor, above.st_uid, above.st_gid) == 0;
}

bool write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

/// So that a name is on the disk, too.
bool sync_folder(const std::filesystem::path& folder) {
  const Descriptor opened{::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  return opened && ::fsync(opened.get()) == 0;
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  const auto above = file.parent_path();
  return above.empty() ? std::filesystem::path{"."} : above;
}

}  // namespace

Result<std::string> read_file(const std::filesystem::path& file, std::size_t bytes_max,
                              Readers readers) {
  const Descriptor opened{::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  if (!opened) return cannot("read", file);
  struct stat is {};
  if (::fstat(opened.get(), &is) != 0) return cannot("read", file);
  if (!S_ISREG(is.st_mode)) return Error{fmt::format("{}: is no file", file.string())};
  if (readers == Readers::owner && (is.st_mode & kOthers) != 0) {
    return Error{
        fmt::format("{0}: others may read it, too (mode {1:04o}); chmod 600 {0}, and make "
                    "new keys if somebody may have",
                    file.string(), is.st_mode & 07777U)};
  }
  std::string text(bytes_max + 1, '\0');
  std::size_t have = 0;
  while (have < text.size()) {
    const ssize_t got = ::read(opened.get(), text.data() + have, text.size() - have);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return cannot("read", file);
    if (got == 0) break;
    have += static_cast<std::size_t>(got);
  }
  if (have > bytes_max) {
    return Error{fmt::format("{}: is longer than {} bytes", file.string(), bytes_max)};
  }
  text.resize(have);
  return text;
}

Result<void> write_file(const std::filesystem::path& file, std::string_view text, Durable durable) {
  const auto folder = folder_of(file);
  const std::string beside = file.string() + ".new";
  ::unlink(beside.c_str());  // of one that was cut off
  {
    const Descriptor made{
        ::open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600)};
    if (!made) return cannot("write", beside);
    if (!give_to_owner_of(folder, made.get()) || !write_all(made.get(), text) ||
        (durable == Durable::yes && ::fsync(made.get()) != 0)) {
      auto error = cannot("write", file);
      ::unlink(beside.c_str());
      return error;
    }
  }
  if (std::rename(beside.c_str(), file.c_str()) != 0) {
    auto error = cannot("write", file);
    ::unlink(beside.c_str());
    return error;
  }
  if (durable == Durable::yes && !sync_folder(folder)) return cannot("write", folder);
  return {};
}

Result<void> make_folder(const std::filesystem::path& folder) {
  std::error_code failed;
  if (std::filesystem::is_directory(folder, failed)) return {};
  const auto above = folder_of(folder);
  std::filesystem::create_directories(above, failed);
  if (failed) {
    return Error{fmt::format("cannot make {}: {}", above.string(), failed.message())};
  }
  if (::mkdir(folder.c_str(), 0700) != 0) return cannot("make", folder);
  const Descriptor opened{::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  if (!opened || !give_to_owner_of(above, opened.get())) return cannot("make", folder);
  return {};
}

bool is_there(const std::filesystem::path& file) {
  std::error_code failed;
  return std::filesystem::exists(file, failed);
}

bool is_free(const std::filesystem::path& folder) {
  std::error_code failed;
  if (!std::filesystem::exists(folder, failed)) return !failed;
  return std::filesystem::is_empty(folder, failed) && !failed;
}

Error of_file(const std::filesystem::path& file, const Error& error) {
  return Error{fmt::format("{}: {}", file.string(), error.message)};
}

Result<FolderLock> FolderLock::take(const std::filesystem::path& folder,
                                    std::chrono::milliseconds within) {
  const int opened = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (opened < 0) return cannot("open", folder);
  const auto until = std::chrono::steady_clock::now() + within;
  while (::flock(opened, LOCK_EX | LOCK_NB) != 0) {
    if (std::chrono::steady_clock::now() >= until) {
      ::close(opened);
      return Error{
          fmt::format("{}: another command has it; wait until that has ended", folder.string())};
    }
    std::this_thread::sleep_for(kLookAgain);
  }
  return FolderLock{opened};
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

FolderLock::FolderLock(FolderLock&& other) noexcept
    : descriptor_{std::exchange(other.descriptor_, -1)} {}

FolderLock& FolderLock::operator=(FolderLock&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

}  // namespace skein::identity
