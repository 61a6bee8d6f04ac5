// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/radio/link_table.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace skein::hil::radio {

namespace {

Error error_of(const std::string& name, int reason) {
  return Error{"radio table " + name + ": " + std::generic_category().message(reason)};
}

}  // namespace

Result<LinkTable> LinkTable::create() {
  static std::atomic<unsigned> number{0};
  for (;;) {
    auto name = "/skein-radio-" + std::to_string(::getpid()) + "-" + std::to_string(++number);
    const int descriptor = ::shm_open(name.c_str(), O_CREAT | O_EXCL | O_RDWR, 0600);
    if (descriptor >= 0) return map(std::move(name), descriptor, true);
    // Taken by one that was killed, or whose process has our number in another namespace.
    if (errno != EEXIST) return error_of(name, errno);
  }
}

Result<LinkTable> LinkTable::open(const std::string& name) {
  const int descriptor = ::shm_open(name.c_str(), O_RDWR, 0);
  if (descriptor >= 0) return map(name, descriptor, false);
  return Error{error_of(name, errno).message + "; it is made by skein-hil, which must be running"};
}

Result<LinkTable> LinkTable::map(std::string name, int descriptor, bool owner) {
  const bool sized = !owner || ::ftruncate(descriptor, sizeof(Table)) == 0;
  void* memory =
      sized ? ::mmap(nullptr, sizeof(Table), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0)
            : MAP_FAILED;
  const int reason = errno;
  ::close(descriptor);
  if (memory == MAP_FAILED) {
    if (owner) ::shm_unlink(name.c_str());
    return error_of(name, reason);
  }
  LinkTable table{std::move(name), static_cast<Table*>(memory), owner};
  if (owner) table.all_hear_all();
  return table;
}

Result<LinkTable> LinkTable::create_private() {
  void* memory =
      ::mmap(nullptr, sizeof(Table), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) {
    return Error{"no memory for a radio table: " + std::generic_category().message(errno)};
  }
  LinkTable table{"", static_cast<Table*>(memory), false};
  table.all_hear_all();
  return table;
}

/// Fresh pages are zero: nobody hears anybody.
void LinkTable::all_hear_all() {
  for (auto& row : table_->hops) {
    for (auto& hops : row) hops = 1;
  }
}

LinkTable::~LinkTable() {
  if (table_ == nullptr) return;
  ::munmap(table_, sizeof(Table));
  if (owner_) ::shm_unlink(name_.c_str());
}

LinkTable::LinkTable(LinkTable&& other) noexcept
    : name_{std::move(other.name_)},
      table_{std::exchange(other.table_, nullptr)},
      owner_{other.owner_} {}

void LinkTable::set(const Link& hop) {
  const auto put = [](auto& place, auto value) { place.store(value, std::memory_order_relaxed); };
  put(table_->hop.loss, hop.loss);
  put(table_->hop.delay_ns, hop.delay.count());
  put(table_->hop.jitter_ns, hop.jitter.count());
  put(table_->hop.disordered, hop.disorder.has_value());
  const Disorder disorder = hop.disorder.value_or(Disorder{});
  put(table_->hop.duplicates, disorder.duplicates);
  put(table_->hop.held_back, disorder.held_back);
  put(table_->hop.held_back_max_ns, disorder.held_back_max.count());
  put(table_->hop.bytes_per_s, hop.bytes_per_s.value_or(0.0));
}

void LinkTable::set_hops(VehicleId from, VehicleId to, int hops) {
  if (from.value >= kNodes || to.value >= kNodes) return;
  table_->hops[from.value][to.value].store(static_cast<std::uint8_t>(hops),
                                           std::memory_order_relaxed);
}

Link LinkTable::get(VehicleId from, VehicleId to) const {
  if (from.value >= kNodes || to.value >= kNodes) return {};
  const auto got = [](const auto& place) { return place.load(std::memory_order_relaxed); };
  const Hop& at = table_->hop;
  Link hop{true, got(at.loss), Duration{got(at.delay_ns)}, Duration{got(at.jitter_ns)}};
  if (got(at.disordered)) {
    hop.disorder = {got(at.duplicates), got(at.held_back), Duration{got(at.held_back_max_ns)}};
  }
  if (const double bytes_per_s = got(at.bytes_per_s); bytes_per_s > 0.0) {
    hop.bytes_per_s = bytes_per_s;
  }
  return over_hops(hop, got(table_->hops[from.value][to.value]));
}

}  // namespace skein::hil::radio
