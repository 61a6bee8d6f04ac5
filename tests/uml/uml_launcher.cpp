// SPDX-License-Identifier: Apache-2.0
//
// uml_launcher LINUX ARGUMENT...
//   Runs a user-mode Linux that ends with its starter, with all of its processes, and that starts
//   on every CPU. Linux 6.1's keeps 2696 bytes of vector registers for each process, as of AVX-512;
//   where a CPU has more (AMX) it stops at its start. There (and with SKEIN_UML_WITHOUT_AVX=1) it
//   is told by a filter of system calls that the kernel has no way to read so many
//   (PTRACE_GETREGSET of NT_X86_XSTATE fails with EIO), upon which it keeps only those of SSE; and
//   its C library is told not to use others.
#include <cpuid.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

constexpr unsigned kExtendedStateLeaf = 0xD;  // EBX: bytes of the registers in use
constexpr unsigned kKeptBytes = 2696;
constexpr unsigned kPtraceGetregset = 0x4204;
constexpr unsigned kNtX86Xstate = 0x202;

bool too_many_registers() {
  unsigned eax = 0;
  unsigned ebx = 0;
  unsigned ecx = 0;
  unsigned edx = 0;
  return __get_cpuid_count(kExtendedStateLeaf, 0, &eax, &ebx, &ecx, &edx) != 0 && ebx > kKeptBytes;
}

constexpr unsigned argument(unsigned index) {  // its lower half
  return static_cast<unsigned>(offsetof(seccomp_data, args) + index * sizeof(__u64));
}

bool hide_vector_registers() {
  constexpr unsigned kLoad = BPF_LD | BPF_W | BPF_ABS;
  constexpr unsigned kEqual = BPF_JMP | BPF_JEQ | BPF_K;
  constexpr unsigned kReturn = BPF_RET | BPF_K;
  std::array<sock_filter, 10> program{{
      BPF_STMT(kLoad, offsetof(seccomp_data, arch)),
      BPF_JUMP(kEqual, AUDIT_ARCH_X86_64, 0, 7),
      BPF_STMT(kLoad, offsetof(seccomp_data, nr)),
      BPF_JUMP(kEqual, SYS_ptrace, 0, 5),
      BPF_STMT(kLoad, argument(0)),
      BPF_JUMP(kEqual, kPtraceGetregset, 0, 3),
      BPF_STMT(kLoad, argument(2)),
      BPF_JUMP(kEqual, kNtX86Xstate, 0, 1),
      BPF_STMT(kReturn, SECCOMP_RET_ERRNO | EIO),
      BPF_STMT(kReturn, SECCOMP_RET_ALLOW),
  }};
  const sock_fprog filter{program.size(), program.data()};
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter, 0, 0) == 0;
}

/// Does not return.
void become(std::vector<char*> arguments) {
  // The kernel hands it on to the environment of its first process.
  std::string without_avx =
      "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX,-AVX2,-AVX512F,-AVX512VL,-AVX512BW,-ERMS,-FSRM";
  // One thread. NOLINTNEXTLINE(concurrency-mt-unsafe)
  if (too_many_registers() || std::getenv("SKEIN_UML_WITHOUT_AVX") != nullptr) {
    if (!hide_vector_registers()) std::perror("uml_launcher: no filter of system calls");
    arguments.push_back(without_avx.data());
  }
  arguments.push_back(nullptr);
  ::execv(arguments.front(), arguments.data());
  std::perror(arguments.front());
  ::_exit(EXIT_FAILURE);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return EXIT_FAILURE;
  sigset_t awaited;
  sigset_t before;
  ::sigemptyset(&awaited);
  for (const int signal : {SIGCHLD, SIGHUP, SIGINT, SIGTERM}) ::sigaddset(&awaited, signal);
  ::pthread_sigmask(SIG_BLOCK, &awaited, &before);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  const pid_t machine = ::fork();
  if (machine < 0) return EXIT_FAILURE;
  if (machine == 0) {
    ::setpgid(0, 0);
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    become({argv + 1, argv + argc});
  }
  int signal = 0;
  int status = 0;
  while (::sigwait(&awaited, &signal) == 0 && signal == SIGCHLD) {
    if (::waitpid(machine, &status, WNOHANG) == machine) break;
  }
  // All of its processes are in its group; its helpers outlive it when it was killed.
  ::kill(-machine, SIGKILL);
  return signal == SIGCHLD && WIFEXITED(status) ? WEXITSTATUS(status) : EXIT_FAILURE;
}
