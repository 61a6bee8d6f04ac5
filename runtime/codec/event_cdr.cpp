// SPDX-License-Identifier: Apache-2.0
#include "event_cdr.hpp"

#include <concepts>
#include <type_traits>

#include "check.hpp"
#include "cut.hpp"
#include "skein/mission/event_fields.hpp"
#include "skein/wire/domain.h"

namespace skein::codec {
namespace {

using eprosima::fastcdr::Cdr;

template <class T>
concept Enumeration = std::is_enum_v<T>;
template <class T>
concept Plain = std::is_arithmetic_v<T>;

void put(Cdr& cdr, Plain auto value) { cdr << value; }
void put(Cdr& cdr, Enumeration auto value) { cdr << static_cast<std::uint32_t>(value); }
void put(Cdr& cdr, Instant t) { cdr << t.time_since_epoch().count(); }
void put(Cdr& cdr, Duration d) { cdr << d.count(); }
void put(Cdr& cdr, const std::string& text) { cdr << cut(text); }
template <class Tag, class Rep>
void put(Cdr& cdr, Id<Tag, Rep> id) {
  cdr << id.value;
}
void put(Cdr& cdr, const std::vector<VehicleId>& ids) {
  cdr << static_cast<std::uint32_t>(ids.size());
  for (const VehicleId id : ids) cdr << id.value;
}
void put(Cdr& cdr, const coalition::Round& round) {
  put(cdr, round.coalition.leader);
  put(cdr, round.coalition.instance);
  put(cdr, round.coalition.number);
  put(cdr, round.number);
}
void put(Cdr& cdr, const TaskId& task) {
  put(cdr, task.site);
  put(cdr, task.kind);
  put(cdr, task.index);
}
template <class Struct>
requires(!std::is_null_pointer_v<std::remove_const_t<decltype(mission::kFields<Struct>)>>) void put(
    Cdr& cdr, const Struct& made) {
  mission::for_each_field(made, [&cdr](auto /*name*/, const auto& value) { put(cdr, value); });
}

/// Takes fields over and checks them.
class Reader {
 public:
  Reader(Cdr& cdr, bool& ok) : cdr_{cdr}, check_{ok}, ok_{ok} {}

  template <Plain T>
  void take(T& value) {
    cdr_ >> value;
    if constexpr (std::floating_point<T>) check_.within(value, -kNumberMax, kNumberMax);
  }
  void take(Enumeration auto& value) {
    std::uint32_t number = 0;
    cdr_ >> number;
    value = check_.enumerator<std::remove_reference_t<decltype(value)>>(number);
  }
  void take(Instant& t) { t = check_.instant(integer()); }
  void take(Duration& d) { d = check_.duration(integer()); }
  void take(std::string& text) {
    std::string value;
    cdr_ >> value;
    check_.require(value.find('\0') == std::string::npos);
    text = check_.text(value);
  }
  template <class Tag, class Rep>
  void take(Id<Tag, Rep>& id) {
    cdr_ >> id.value;
  }
  void take(std::vector<VehicleId>& ids) {
    std::uint32_t count = 0;
    cdr_ >> count;
    check_.require(count <= formation::kMoversMax);
    if (!ok_) return;
    ids.resize(count);
    for (VehicleId& id : ids) take(id);
  }
  void take(coalition::Round& round) {
    take(round.coalition.leader);
    take(round.coalition.instance);
    take(round.coalition.number);
    take(round.number);
  }
  void take(TaskId& task) {
    take(task.site);
    take(task.kind);
    take(task.index);
    check_.require(task.index < kTasksPerKindMax);
  }
  template <class Struct>
  requires(!std::is_null_pointer_v<
           std::remove_const_t<decltype(mission::kFields<Struct>)>>) void take(Struct& made) {
    mission::for_each_field(made, [this](auto /*name*/, auto& value) { take(value); });
  }
  void take(mission::EventBody& body) {
    mission::EventKind kind{};
    take(kind);
    if (!ok_) return;
    body = mission::body_of(kind);
    std::visit([this](auto& made) { take(made); }, body);
  }

 private:
  std::int64_t integer() {
    std::int64_t value = 0;
    cdr_ >> value;
    return value;
  }

  Cdr& cdr_;
  Check check_;
  bool& ok_;
};

}  // namespace

void write(Cdr& cdr, const mission::MissionEvent& event) {
  cdr << wire::kVersion;
  put(cdr, event.vehicle);
  put(cdr, event.time);
  put(cdr, event.round);
  put(cdr, event.task);
  put(cdr, event.kind());
  std::visit([&cdr](const auto& made) { put(cdr, made); }, event.body);
}

mission::MissionEvent read_event(Cdr& cdr, bool& ok) {
  Reader reader{cdr, ok};
  mission::MissionEvent event;
  reader.take(event.vehicle);
  reader.take(event.time);
  reader.take(event.round);
  reader.take(event.task);
  reader.take(event.body);
  return event;
}

}  // namespace skein::codec
