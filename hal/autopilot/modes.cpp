// SPDX-License-Identifier: Apache-2.0
#include "skein/autopilot/modes.hpp"

#include <algorithm>

namespace skein::autopilot {
namespace {

template <class Mode, class Event>
struct Named {
  Mode mode;
  Event selection;
  std::string_view name;
};

constexpr std::array kPlane{
    Named<PlaneMode, PlaneEvent>{PlaneMode::manual, PlaneEvent::select_manual, "MANUAL"},
    Named<PlaneMode, PlaneEvent>{PlaneMode::fbwa, PlaneEvent::select_fbwa, "FBWA"},
    Named<PlaneMode, PlaneEvent>{PlaneMode::mission, PlaneEvent::select_mission, "AUTO"},
    Named<PlaneMode, PlaneEvent>{PlaneMode::rtl, PlaneEvent::select_rtl, "RTL"},
    Named<PlaneMode, PlaneEvent>{PlaneMode::loiter, PlaneEvent::select_loiter, "LOITER"},
    Named<PlaneMode, PlaneEvent>{PlaneMode::takeoff, PlaneEvent::select_takeoff, "TAKEOFF"},
    Named<PlaneMode, PlaneEvent>{PlaneMode::guided, PlaneEvent::select_guided, "GUIDED"},
    Named<PlaneMode, PlaneEvent>{PlaneMode::q_loiter, PlaneEvent::select_q_loiter, "QLOITER"},
    Named<PlaneMode, PlaneEvent>{PlaneMode::q_land, PlaneEvent::select_q_land, "QLAND"},
    Named<PlaneMode, PlaneEvent>{PlaneMode::q_rtl, PlaneEvent::select_q_rtl, "QRTL"},
};
constexpr std::array kCopter{
    Named<CopterMode, CopterEvent>{CopterMode::stabilize, CopterEvent::select_stabilize,
                                   "STABILIZE"},
    Named<CopterMode, CopterEvent>{CopterMode::guided, CopterEvent::select_guided, "GUIDED"},
    Named<CopterMode, CopterEvent>{CopterMode::loiter, CopterEvent::select_loiter, "LOITER"},
    Named<CopterMode, CopterEvent>{CopterMode::rtl, CopterEvent::select_rtl, "RTL"},
    Named<CopterMode, CopterEvent>{CopterMode::land, CopterEvent::select_land, "LAND"},
};

/// Every mode is in its table, so the search always finds.
template <class Table, class Mode>
constexpr const auto& named(const Table& table, Mode mode) {
  return *std::find_if(table.begin(), table.end(), [&](const auto& n) { return n.mode == mode; });
}

template <class Mode, class Table>
std::optional<Mode> numbered(const Table& table, std::uint32_t number) {
  for (const auto& n : table) {
    if (static_cast<std::uint32_t>(n.mode) == number) return n.mode;
  }
  return std::nullopt;
}

}  // namespace

std::string_view to_string(PlaneMode mode) { return named(kPlane, mode).name; }
std::string_view to_string(CopterMode mode) { return named(kCopter, mode).name; }
std::optional<PlaneMode> plane_mode(std::uint32_t number) {
  return numbered<PlaneMode>(kPlane, number);
}
std::optional<CopterMode> copter_mode(std::uint32_t number) {
  return numbered<CopterMode>(kCopter, number);
}
PlaneEvent selection_of(PlaneMode mode) { return named(kPlane, mode).selection; }
CopterEvent selection_of(CopterMode mode) { return named(kCopter, mode).selection; }

}  // namespace skein::autopilot
