// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>

#include "gate.hpp"
#include "http.hpp"
#include "skein/console/server.hpp"

namespace skein::console {

/// What machines ask: /health, JSON with the status 200 or 503, and /metrics, as Prometheus reads
/// them. Who is on this machine needs no login; others are let in as to the page.
class MachinePages {
 public:
  using Time = std::chrono::steady_clock::time_point;
  /// A report that is older says that whoever makes them does not get on.
  static constexpr std::chrono::seconds kReportAgeMax{10};

  /// `gate` must outlive this.
  explicit MachinePages(const Gate& gate) : gate_{&gate} {}

  void report(Server::MachineReport report, Time now) {
    report_ = std::move(report);
    reported_at_ = now;
  }
  /// Nothing where the request is for another page.
  [[nodiscard]] std::optional<HttpResponse> respond(const HttpRequest& request, Time now) const;

 private:
  const Gate* gate_;
  std::optional<Server::MachineReport> report_;
  Time reported_at_{};
};

}  // namespace skein::console
