// SPDX-License-Identifier: Apache-2.0
#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "hostile.hpp"
#include "skein/network/transport_plugin.hpp"

namespace skein::isolation {
namespace {

namespace rtps = eprosima::fastdds::rtps;
using eprosima::fastrtps::rtps::Locator_t;
using eprosima::fastrtps::rtps::LocatorsIterator;
using eprosima::fastrtps::rtps::octet;
using eprosima::fastrtps::rtps::SenderResource;

/// By hand: what a library does with errno or after is not asked for.
template <class... Arguments>
int tried(long call, Arguments... arguments) {
  return syscall(call, arguments...) < 0 ? errno : 0;
}

int tried_open(const char* path, int flags) {
  const int file = open(path, flags | O_CLOEXEC, 0600);
  if (file < 0) return errno;
  close(file);
  return 0;
}

int tried_fork() {
  const long child = syscall(SYS_clone, SIGCHLD, nullptr, nullptr, nullptr, nullptr);
  if (child < 0) return errno;
  if (child == 0) _exit(0);
  waitpid(static_cast<pid_t>(child), nullptr, 0);
  return 0;
}

int tried_memory(int protection) {
  constexpr std::size_t kBytes = 4096;
  void* const memory = mmap(nullptr, kBytes, protection, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return errno;
  munmap(memory, kBytes);
  return 0;
}

int tried_socket(int family, int kind) {
  const int made = socket(family, kind | SOCK_CLOEXEC, 0);
  if (made < 0) return errno;
  close(made);
  return 0;
}

/// Of the process that started this one.
int tried_inherited_files() {
  constexpr int kDescriptors = 1024;
  for (int descriptor = 0; descriptor < kDescriptors; ++descriptor) {
    struct stat about {};
    if (syscall(SYS_fstat, descriptor, &about) == 0 && about.st_size == kInheritedBytes) return 0;
  }
  return EPERM;
}

/// `agent`: the process that this one carries for.
std::string escape(pid_t agent, const std::string& folder) {
  std::string report;
  const auto note = [&report](const char* name, int error) {
    report.append(name).append(" ").append(std::to_string(error)).append("\n");
  };
  char byte = 0;
  const iovec here{&byte, 1};
  const std::array<char*, 1> none{nullptr};
  note("exec", tried(SYS_execve, "/nonexistent", none.data(), none.data()));
  note("fork", tried_fork());
  note("write-file", tried_open((folder + "/made").c_str(), O_WRONLY | O_CREAT));
  note("read-file", tried_open("/etc/passwd", O_RDONLY));
  note("unlink", tried(SYS_unlinkat, AT_FDCWD, (folder + "/there").c_str(), 0));
  note("inherited-file", tried_inherited_files());
  note("trace", tried(SYS_ptrace, PTRACE_PEEKDATA, agent, nullptr, nullptr));
  note("read-agent", tried(SYS_process_vm_readv, agent, &here, 1UL, &here, 1UL, 0UL));
  note("kill", tried(SYS_kill, agent, 0));
  note("signal-thread", tried(SYS_tgkill, agent, agent, 0));
  note("limits", tried(SYS_prlimit64, agent, RLIMIT_NOFILE, nullptr, nullptr));
  note("pidfd", tried(SYS_pidfd_open, agent, 0));
  note("unix-socket", tried_socket(AF_UNIX, SOCK_STREAM));
  note("udp-socket", tried_socket(AF_INET, SOCK_DGRAM));
  note("code", tried_memory(PROT_READ | PROT_EXEC));
  note("memory-file", tried(SYS_memfd_create, "x", MFD_CLOEXEC));
  note("setuid", tried(SYS_setuid, getuid()));
  note("plain-memory", tried_memory(PROT_READ | PROT_WRITE));  // that not just all is refused
  return report;
}

struct HostileDescriptor : rtps::ChainingTransportDescriptor {
  explicit HostileDescriptor(std::shared_ptr<rtps::TransportDescriptorInterface> low)
      : ChainingTransportDescriptor{std::move(low)} {}
  rtps::TransportInterface* create_transport() const override;
};

class HostileTransport : public rtps::ChainingTransport {
 public:
  explicit HostileTransport(const HostileDescriptor& descriptor)
      : ChainingTransport{descriptor}, descriptor_{descriptor} {}
  rtps::TransportDescriptorInterface* get_configuration() override { return &descriptor_; }

  bool send(SenderResource* sender, const octet* buffer, std::uint32_t size,
            LocatorsIterator* begin, LocatorsIterator* end,
            const std::chrono::steady_clock::time_point& timeout) override {
    while (hangs_) std::this_thread::sleep_for(std::chrono::milliseconds{10});
    return sender->send(buffer, size, begin, end, timeout);
  }

  void receive(rtps::TransportReceiverInterface* next, const octet* buffer, std::uint32_t size,
               const Locator_t& local, const Locator_t& remote) override {
    const std::string_view text{reinterpret_cast<const char*>(buffer), size};
    if (!text.starts_with(kOrder)) return next->OnDataReceived(buffer, size, local, remote);
    obey(std::string{text.substr(kOrder.size())}, remote);
  }

 private:
  void obey(const std::string& order, const Locator_t& from) {
    if (order == kCrash) raise(SIGSEGV);
    if (order == kHang) hangs_ = true;
    while (order == kLeak) {
      constexpr std::size_t kBytes = 1U << 20U;
      std::memset(new char[kBytes], 1, kBytes);
    }
    if (!order.starts_with(kEscape)) return;
    // "escape PID FOLDER"
    const auto space = order.find(' ', kEscape.size() + 1);
    const auto agent = static_cast<pid_t>(std::stol(order.substr(kEscape.size() + 1)));
    const std::string report = escape(agent, order.substr(space + 1));
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(from.port));
    std::copy_n(&from.address[12], 4, reinterpret_cast<octet*>(&to.sin_addr));
    (void)!sendto(answers_, report.data(), report.size(), 0, reinterpret_cast<const sockaddr*>(&to),
                  sizeof to);
  }

  HostileDescriptor descriptor_;
  const int answers_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  std::atomic<bool> hangs_{false};
};

rtps::TransportInterface* HostileDescriptor::create_transport() const {
  return new HostileTransport{*this};  // Fast DDS owns it
}

}  // namespace
}  // namespace skein::isolation

extern "C" __attribute__((visibility("default"))) const char* skein_wrap_transport(
    std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface>& transport,
    std::uint16_t) {
  transport = std::make_shared<skein::isolation::HostileDescriptor>(transport);
  return nullptr;
}
