// SPDX-License-Identifier: Apache-2.0
#include "confinement.hpp"

#include <fcntl.h>
#include <linux/capability.h>
#include <seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <memory>
#include <string_view>
#include <system_error>

namespace skein::network {
namespace {

std::string reason() { return std::generic_category().message(errno); }

bool limit(__rlimit_resource what, rlim_t most) {
  const rlimit both{most, most};
  return setrlimit(what, &both) == 0;
}

bool drop_capabilities() {
  for (int capability = 0; prctl(PR_CAPBSET_READ, capability) >= 0; ++capability) {
    (void)prctl(PR_CAPBSET_DROP, capability);  // who may not has none to lose
  }
  (void)prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_CLEAR_ALL, 0, 0, 0);
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> sets{};
  if (syscall(SYS_capset, &header, sets.data()) == 0) return true;
  // A service manager may have forbidden the call, after it had taken them all itself.
  if (syscall(SYS_capget, &header, sets.data()) != 0) return false;
  return std::ranges::all_of(sets, [](const __user_cap_data_struct& set) {
    return set.effective == 0 && set.permitted == 0 && set.inheritable == 0;
  });
}

/// The kernel's killer takes it before the agent.
void go_first() {
  const int file = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (file < 0) return;
  constexpr std::string_view kBefore = "500";
  (void)!write(file, kBefore.data(), kBefore.size());
  close(file);
}

struct Release {
  void operator()(void* filter) const { seccomp_release(filter); }
};
using Filter = std::unique_ptr<void, Release>;

/// To work with what there is: descriptors, memory, time, its own threads.
constexpr std::array kAlways{"read",
                             "write",
                             "readv",
                             "writev",
                             "close",
                             "recvfrom",
                             "recvmsg",
                             "recvmmsg",
                             "sendto",
                             "sendmsg",
                             "sendmmsg",
                             "poll",
                             "ppoll",
                             "select",
                             "pselect6",
                             "epoll_wait",
                             "epoll_pwait",
                             "epoll_ctl",
                             "shutdown",
                             "getsockname",
                             "getpeername",
                             "getsockopt",
                             "setsockopt",
                             "ioctl",
                             "fcntl",
                             "fstat",
                             "getrusage",
                             "sysinfo",
                             "futex",
                             "set_robust_list",
                             "rseq",
                             "restart_syscall",
                             "clock_gettime",
                             "clock_getres",
                             "clock_nanosleep",
                             "nanosleep",
                             "gettimeofday",
                             "time",
                             "brk",
                             "munmap",
                             "mremap",
                             "madvise",
                             "exit",
                             "exit_group",
                             "rt_sigreturn",
                             "rt_sigaction",
                             "rt_sigprocmask",
                             "sigaltstack",
                             "getpid",
                             "gettid",
                             "sched_yield",
                             "sched_getaffinity",
                             "getrandom",
                             "membarrier",
                             "timerfd_settime"};

/// False with the reason in errno.
bool allow(const Filter& filter, const char* call) {
  const int number = seccomp_syscall_resolve_name(call);
  if (number < 0) return true;  // an architecture that has it not
  const int status = seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, number, 0);
  errno = -status;
  return status == 0;
}

/// Where the argument, masked, has that value.
bool allow_if(const Filter& filter, int call, unsigned argument, std::uint64_t mask,
              std::uint64_t value) {
  const scmp_arg_cmp held{argument, SCMP_CMP_MASKED_EQ, mask, value};
  const int status = seccomp_rule_add_array(filter.get(), SCMP_ACT_ALLOW, call, 1, &held);
  errno = -status;
  return status == 0;
}

constexpr std::uint64_t kWhole = ~std::uint64_t{0};

bool allow_work(const Filter& filter) {
  for (const char* call : kAlways) {
    if (!allow(filter, call)) return false;
  }
  // abort() and the like, and to no other process.
  return allow_if(filter, SCMP_SYS(tgkill), 0, kWhole, static_cast<std::uint64_t>(getpid())) &&
         allow_if(filter, SCMP_SYS(mmap), 2, PROT_EXEC, 0) &&
         allow_if(filter, SCMP_SYS(mprotect), 2, PROT_EXEC, 0);
}

bool allow_opening(const Filter& filter) {
  for (const char* call : {"seccomp", "prctl", "bind", "uname", "timerfd_create", "epoll_create1",
                           "eventfd2", "prlimit64", "sched_getparam", "sched_getscheduler"}) {
    if (!allow(filter, call)) return false;
  }
  return allow_if(filter, SCMP_SYS(socket), 0, kWhole, AF_INET) &&
         allow_if(filter, SCMP_SYS(socket), 0, kWhole, AF_NETLINK) &&  // which addresses it has
         allow_if(filter, SCMP_SYS(clone), 0, CLONE_THREAD, CLONE_THREAD);
}

}  // namespace

std::string give_up_rights(int keep) {
  std::string failed;
  const auto note = [&failed](bool done, const char* what) {
    if (!done) failed.append(failed.empty() ? "" : "; ").append(what).append(": ").append(reason());
  };
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  // How it ends is for its parent to say.
  for (const int stop : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) (void)signal(stop, SIG_IGN);
  const auto first = static_cast<unsigned>(keep) + 1;
  note(close_range(first, ~0U, 0) == 0, "descriptors are open");
  go_first();
  note(drop_capabilities(), "capabilities are kept");
  note(prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0, "privileges can be had");
  note(prctl(PR_SET_DUMPABLE, 0, 0, 0, 0) == 0, "others may look into it");
  note(limit(RLIMIT_CORE, 0) && limit(RLIMIT_RTPRIO, 0) && limit(RLIMIT_MEMLOCK, 0),
       "limits are as before");
  if (!kSanitized) note(limit(RLIMIT_DATA, kCarrierMemoryMax), "memory is not limited");
  return failed;
}

std::string keep_only(Calls calls) {
  if (kSanitized) return {};
  const Filter filter{seccomp_init(SCMP_ACT_ERRNO(EPERM))};
  if (!filter) return "system calls are not limited: no memory";
  bool made = allow_work(filter) && (calls == Calls::open || allow_opening(filter));
  // Older C libraries must make threads by clone(), whose arguments can be seen here.
  made = made && seccomp_rule_add(filter.get(), SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(clone3), 0) == 0 &&
         seccomp_attr_set(filter.get(), SCMP_FLTATR_CTL_TSYNC, 1) == 0;
  if (!made) return "system calls are not limited: " + reason();
  const int status = seccomp_load(filter.get());
  errno = -status;
  return status == 0 ? std::string{} : "system calls are not limited: " + reason();
}

}  // namespace skein::network
