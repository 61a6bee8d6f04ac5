// SPDX-License-Identifier: Apache-2.0
#include "machine_pages.hpp"

namespace skein::console {

std::optional<HttpResponse> MachinePages::respond(const HttpRequest& request, Time now) const {
  const std::string_view target = request.target;
  const std::string_view path = target.substr(0, target.find('?'));
  const bool metrics = path == "/metrics";
  if (!metrics && path != "/health") return std::nullopt;
  if (!gate_->is_own_host(request.host)) return std::nullopt;  // refused as every page
  if (request.method != HttpMethod::get && request.method != HttpMethod::head) return std::nullopt;
  if (!request.local && !gate_->identify(request.cookie, now)) {
    return HttpResponse{HttpStatus::unauthorized, media::kJson, R"({"error":"log in first"})"};
  }
  if (!report_ || now - reported_at_ > kReportAgeMax) {
    return HttpResponse{HttpStatus::service_unavailable, media::kJson,
                        R"({"healthy":false,"problems":["the ground station does not get on"]})"};
  }
  if (metrics) {
    return HttpResponse{HttpStatus::ok, "text/plain; version=0.0.4; charset=utf-8",
                        report_->metrics};
  }
  return HttpResponse{report_->healthy ? HttpStatus::ok : HttpStatus::service_unavailable,
                      media::kJson, report_->health};
}

}  // namespace skein::console
