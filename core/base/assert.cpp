// SPDX-License-Identifier: Apache-2.0
#include "skein/base/assert.hpp"

#include <atomic>
#include <cstdio>
#include <cstdlib>

namespace skein {
namespace {
void print_and_abort(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: broken invariant: %s\n", file, line, condition);
  std::abort();
}
std::atomic<AssertHandler> g_handler{&print_and_abort};
}  // namespace

void set_assert_handler(AssertHandler handler) { g_handler = handler; }

void assert_failed(const char* condition, const char* file, int line) {
  g_handler.load()(condition, file, line);
  std::abort();  // a handler that returns is itself a broken invariant
}

}  // namespace skein
