// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/radio/link_table.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace skein::hil::radio {

Result<LinkTable> LinkTable::create() {
  static std::atomic<unsigned> number{0};
  return map("/skein-radio-" + std::to_string(::getpid()) + "-" + std::to_string(++number), true);
}

Result<LinkTable> LinkTable::open(const std::string& name) { return map(name, false); }

Result<LinkTable> LinkTable::map(const std::string& name, bool create) {
  const int flags = create ? O_CREAT | O_EXCL | O_RDWR : O_RDWR;
  const int descriptor = ::shm_open(name.c_str(), flags, 0600);
  if (descriptor < 0) {
    return Error{"radio table " + name + ": " + std::generic_category().message(errno) +
                 (create ? "" : "; it is made by skein-hil, which must be running")};
  }
  const bool sized = !create || ::ftruncate(descriptor, sizeof(Table)) == 0;
  void* memory =
      sized ? ::mmap(nullptr, sizeof(Table), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0)
            : MAP_FAILED;
  const int reason = errno;
  ::close(descriptor);
  if (memory == MAP_FAILED) {
    if (create) ::shm_unlink(name.c_str());
    return Error{"radio table " + name + ": " + std::generic_category().message(reason)};
  }
  LinkTable table{name, static_cast<Table*>(memory), create};
  if (create) table.all_up();
  return table;
}

Result<LinkTable> LinkTable::create_private() {
  void* memory =
      ::mmap(nullptr, sizeof(Table), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) {
    return Error{"no memory for a radio table: " + std::generic_category().message(errno)};
  }
  LinkTable table{"", static_cast<Table*>(memory), false};
  table.all_up();
  return table;
}

/// Fresh pages are zero: every link down.
void LinkTable::all_up() {
  for (auto& row : table_->cells) {
    for (auto& cell : row) cell.up = true;
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

void LinkTable::set(VehicleId from, VehicleId to, const Link& link) {
  if (from.value >= kNodes || to.value >= kNodes) return;
  auto& cell = table_->cells[from.value][to.value];
  const auto put = [](auto& place, auto value) { place.store(value, std::memory_order_relaxed); };
  put(cell.up, link.up);
  put(cell.loss, link.loss);
  put(cell.delay_ns, link.delay.count());
  put(cell.jitter_ns, link.jitter.count());
  put(cell.disordered, link.disorder.has_value());
  const Disorder disorder = link.disorder.value_or(Disorder{});
  put(cell.duplicates, disorder.duplicates);
  put(cell.held_back, disorder.held_back);
  put(cell.held_back_max_ns, disorder.held_back_max.count());
}

Link LinkTable::get(VehicleId from, VehicleId to) const {
  if (from.value >= kNodes || to.value >= kNodes) return {};
  const auto& cell = table_->cells[from.value][to.value];
  const auto got = [](const auto& place) { return place.load(std::memory_order_relaxed); };
  Link link{got(cell.up), got(cell.loss), Duration{got(cell.delay_ns)},
            Duration{got(cell.jitter_ns)}};
  if (got(cell.disordered)) {
    link.disorder = {got(cell.duplicates), got(cell.held_back),
                     Duration{got(cell.held_back_max_ns)}};
  }
  return link;
}

}  // namespace skein::hil::radio
