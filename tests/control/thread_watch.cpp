// SPDX-License-Identifier: Apache-2.0
//
// What the threads of skein-onboard ask of the rest of the system, counted in the program as it
// flies: LD_PRELOAD=libskein_thread_watch.so SKEIN_THREAD_WATCH=FOLDER skein-onboard ... It stands
// before the C library and DDS. Of the threads named control, can and agent it counts allocations,
// locks (mutexes, conditions, semaphores), DDS writes, and calls that go to files, sockets
// or wait. A thread that sleeps until a time (control) is counted from one wake-up to its next
// sleep, so what it does at its start and end is left out; and how late it wakes is put in a
// histogram, as cyclictest does. Of received CAN frames it is how old they are when read, by the
// kernel's time. At the end of the process there is FOLDER/PID.txt, a line a thread of key=value.
#include <dlfcn.h>
#include <poll.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <string_view>
#include <utility>

namespace {

enum Kind : std::size_t { allocations, locks, dds, input_output, kinds };
constexpr std::array<const char*, kinds> kKindNames{"allocations", "locks", "dds", "io"};

struct Watched {
  std::string_view name;
  std::array<std::uint64_t, kinds> calls{};
  std::array<std::uint64_t, kinds> since_wake{};
  std::uint64_t sleeps = 0;
  rusage at_first{};
  rusage at_last{};
  timespec began{};
  timespec ended{};
  std::array<std::uint32_t, 100'000> microseconds{};  ///< the last bin holds all that is more
};

std::array<Watched, 3> g_watched{{{.name = "control"}, {.name = "can"}, {.name = "agent"}}};

/// Of this thread. Plain data in the static block, so that malloc can look at it.
struct Self {
  Watched* watched;
  unsigned asked;  ///< how often for its name, which it gets only after its start
};
[[gnu::tls_model("initial-exec")]] thread_local Self g_self{};

constexpr unsigned kAskedMax = 2000;

Watched* watched() {
  if (g_self.watched != nullptr || g_self.asked >= kAskedMax) return g_self.watched;
  ++g_self.asked;
  std::array<char, 17> name{};
  ::prctl(PR_GET_NAME, name.data());
  for (Watched& each : g_watched) {
    if (each.name != name.data()) continue;
    g_self.watched = &each;
    ::getrusage(RUSAGE_THREAD, &each.at_first);
    ::clock_gettime(CLOCK_MONOTONIC, &each.began);
  }
  return g_self.watched;
}

void count(Kind kind) {
  if (Watched* self = watched()) ++self->since_wake[kind];
}

void commit(Watched& self) {
  for (std::size_t kind = 0; kind < kinds; ++kind) {
    self.calls[kind] += std::exchange(self.since_wake[kind], 0);
  }
  ::getrusage(RUSAGE_THREAD, &self.at_last);
  ::clock_gettime(CLOCK_MONOTONIC, &self.ended);
}

constexpr std::int64_t nanoseconds(const timespec& t) {
  return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}
constexpr double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

void record(Watched& self, std::int64_t late_ns) {
  const auto last = static_cast<std::int64_t>(self.microseconds.size()) - 1;
  ++self.microseconds[static_cast<std::size_t>(std::clamp<std::int64_t>(late_ns / 1000, 0, last))];
}

double percentile(const Watched& self, std::uint64_t total, double part) {
  std::uint64_t seen = 0;
  for (std::size_t us = 0; us < self.microseconds.size(); ++us) {
    seen += self.microseconds[us];
    if (seen > 0 && static_cast<double>(seen) >= part * static_cast<double>(total)) {
      return static_cast<double>(us);
    }
  }
  return 0.0;
}

void print(std::FILE* file, const Watched& self) {
  std::uint64_t total = 0;
  for (const auto bin : self.microseconds) total += bin;
  const double elapsed =
      1e-9 * static_cast<double>(nanoseconds(self.ended) - nanoseconds(self.began));
  const double busy = seconds(self.at_last.ru_utime) + seconds(self.at_last.ru_stime) -
                      seconds(self.at_first.ru_utime) - seconds(self.at_first.ru_stime);
  std::fprintf(file, "thread=%.*s seconds=%.1f sleeps=%llu", static_cast<int>(self.name.size()),
               self.name.data(), elapsed, static_cast<unsigned long long>(self.sleeps));
  for (std::size_t kind = 0; kind < kinds; ++kind) {
    std::fprintf(file, " %s=%llu", kKindNames[kind],
                 static_cast<unsigned long long>(self.calls[kind]));
  }
  std::fprintf(file, " waits=%ld faults=%ld cpu_percent=%.2f",
               self.at_last.ru_nvcsw - self.at_first.ru_nvcsw,
               self.at_last.ru_majflt - self.at_first.ru_majflt,
               elapsed > 0.0 ? 100.0 * busy / elapsed : 0.0);
  std::fprintf(file, " timed=%llu p50_us=%.0f p99_us=%.0f p999_us=%.0f max_us=%.0f\n",
               static_cast<unsigned long long>(total), percentile(self, total, 0.5),
               percentile(self, total, 0.99), percentile(self, total, 0.999),
               percentile(self, total, 1.0));
}

[[gnu::destructor]] void report() {
  // Nobody else is left. NOLINTNEXTLINE(concurrency-mt-unsafe)
  const char* folder = std::getenv("SKEIN_THREAD_WATCH");
  if (folder == nullptr || g_watched[0].sleeps == 0) return;
  const std::string path = std::string{folder} + "/" + std::to_string(::getpid()) + ".txt";
  if (std::FILE* file = std::fopen(path.c_str(), "w")) {
    for (const Watched& self : g_watched) {
      if (self.ended.tv_sec != 0) print(file, self);
    }
    std::fclose(file);
  }
}

template <class Function>
Function* next(Function* /*type*/, const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): others gave these names
// The C library's own names for what it allocates with: dlsym allocates, so malloc cannot ask it.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) {
  count(allocations);
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
  count(allocations);
  return __libc_calloc(number, size);
}
void* realloc(void* memory, std::size_t size) {
  count(allocations);
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  count(allocations);
  return __libc_memalign(alignment, size);
}
void free(void* memory) {
  if (memory != nullptr) count(allocations);
  __libc_free(memory);
}

#define SKEIN_FORWARD(kind, result, name, parameters, arguments) \
  result name parameters {                                       \
    static const auto real = next(&(name), #name);               \
    count(kind);                                                 \
    return real arguments;                                       \
  }
SKEIN_FORWARD(locks, int, pthread_mutex_lock, (pthread_mutex_t * m), (m))
SKEIN_FORWARD(locks, int, pthread_mutex_trylock, (pthread_mutex_t * m), (m))
SKEIN_FORWARD(locks, int, pthread_rwlock_rdlock, (pthread_rwlock_t * l), (l))
SKEIN_FORWARD(locks, int, pthread_rwlock_wrlock, (pthread_rwlock_t * l), (l))
SKEIN_FORWARD(locks, int, pthread_cond_signal, (pthread_cond_t * c), (c))
SKEIN_FORWARD(locks, int, pthread_cond_broadcast, (pthread_cond_t * c), (c))
SKEIN_FORWARD(locks, int, pthread_cond_wait, (pthread_cond_t * c, pthread_mutex_t* m), (c, m))
SKEIN_FORWARD(locks, int, pthread_cond_timedwait,
              (pthread_cond_t * c, pthread_mutex_t* m, const timespec* t), (c, m, t))
SKEIN_FORWARD(locks, int, pthread_cond_clockwait,
              (pthread_cond_t * c, pthread_mutex_t* m, clockid_t k, const timespec* t),
              (c, m, k, t))
SKEIN_FORWARD(locks, int, sem_wait, (sem_t * s), (s))
SKEIN_FORWARD(locks, int, sem_post, (sem_t * s), (s))
SKEIN_FORWARD(input_output, ssize_t, read, (int f, void* b, std::size_t n), (f, b, n))
SKEIN_FORWARD(input_output, ssize_t, write, (int f, const void* b, std::size_t n), (f, b, n))
SKEIN_FORWARD(input_output, ssize_t, send, (int f, const void* b, std::size_t n, int o),
              (f, b, n, o))
SKEIN_FORWARD(input_output, ssize_t, sendmsg, (int f, const msghdr* m, int o), (f, m, o))
SKEIN_FORWARD(input_output, ssize_t, sendto,
              (int f, const void* b, std::size_t n, int o, const sockaddr* a, socklen_t l),
              (f, b, n, o, a, l))
SKEIN_FORWARD(input_output, int, poll, (pollfd * f, nfds_t n, int t), (f, n, t))
SKEIN_FORWARD(input_output, int, ppoll,
              (pollfd * f, nfds_t n, const timespec* t, const sigset_t* s), (f, n, t, s))
SKEIN_FORWARD(input_output, int, fflush, (std::FILE * f), (f))
SKEIN_FORWARD(input_output, std::size_t, fwrite,
              (const void* b, std::size_t s, std::size_t n, std::FILE* f), (b, s, n, f))

ssize_t recvmsg(int socket, msghdr* message, int flags) {
  static const auto real = next(&recvmsg, "recvmsg");
  count(input_output);
  const ssize_t size = real(socket, message, flags);
  Watched* self = g_self.watched;
  if (size < 0 || self == nullptr) return size;
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  for (cmsghdr* item = CMSG_FIRSTHDR(message); item != nullptr; item = CMSG_NXTHDR(message, item)) {
    if (item->cmsg_level != SOL_SOCKET || item->cmsg_type != SCM_TIMESTAMPNS) continue;
    timespec received{};
    std::memcpy(&received, CMSG_DATA(item), sizeof(received));
    record(*self, nanoseconds(now) - nanoseconds(received));
    commit(*self);
  }
  return size;
}

int clock_nanosleep(clockid_t clock, int flags, const timespec* until, timespec* left) {
  static const auto real = next(&clock_nanosleep, "clock_nanosleep");
  Watched* self = watched();
  if (self != nullptr && self->sleeps > 0) commit(*self);
  const int result = real(clock, flags, until, left);
  if (self == nullptr || result != 0 || flags != TIMER_ABSTIME) return result;
  if (self->sleeps++ == 0) {  // from here on
    self->since_wake = {};
    ::getrusage(RUSAGE_THREAD, &self->at_first);
    ::clock_gettime(CLOCK_MONOTONIC, &self->began);
  }
  timespec now{};
  ::clock_gettime(clock, &now);
  record(*self, nanoseconds(now) - nanoseconds(*until));
  return result;
}

// eprosima::fastdds::dds::DataWriter::write(void*), by the name that the linker knows it by.
// Reading takes a lock, and is counted so.
bool _ZN8eprosima7fastdds3dds10DataWriter5writeEPv(void* writer, void* data) {
  static const auto real = next(&_ZN8eprosima7fastdds3dds10DataWriter5writeEPv,
                                "_ZN8eprosima7fastdds3dds10DataWriter5writeEPv");
  count(dds);
  return real(writer, data);
}
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
