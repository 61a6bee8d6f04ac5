// SPDX-License-Identifier: Apache-2.0
#include "counted_calls.hpp"

#include <dlfcn.h>
#include <pthread.h>

#include <atomic>
#include <cstdlib>
#include <new>

#if defined(__has_feature)
#define SKEIN_HAS_FEATURE(x) __has_feature(x)
#else
#define SKEIN_HAS_FEATURE(x) 0
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || \
    SKEIN_HAS_FEATURE(address_sanitizer) || SKEIN_HAS_FEATURE(thread_sanitizer)
#define SKEIN_COUNTS_CALLS 0
#else
#define SKEIN_COUNTS_CALLS 1
#endif

namespace counted_calls {
namespace {
std::atomic<int> g_allocations{0};
std::atomic<int> g_locks{0};
}  // namespace

bool available() { return SKEIN_COUNTS_CALLS != 0; }
int allocations() { return g_allocations; }
int locks() { return g_locks; }
void reset() {
  g_allocations = 0;
  g_locks = 0;
}

}  // namespace counted_calls

#if SKEIN_COUNTS_CALLS
// NOLINTBEGIN(cppcoreguidelines-no-malloc): operator new is made of it
void* operator new(std::size_t size) {
  ++counted_calls::g_allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc{};
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
// NOLINTEND(cppcoreguidelines-no-malloc)

extern "C" int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  using Lock = int (*)(pthread_mutex_t*);
  static const auto real = reinterpret_cast<Lock>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  ++counted_calls::g_locks;
  return real(mutex);
}
#endif
