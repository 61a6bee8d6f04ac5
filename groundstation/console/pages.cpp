// SPDX-License-Identifier: Apache-2.0
#include "pages.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <iterator>
#include <utility>

#include "assets.hpp"
#include "skein/codec/json_text.hpp"

namespace skein::console {
namespace {

std::optional<unsigned> number(std::string_view text) {
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

const Asset* asset_of(std::string_view path) {
  const auto all = assets();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [path](const Asset& asset) { return asset.path == path; });
  return found != all.end() ? &*found : nullptr;
}

}  // namespace

Result<Pages> Pages::open(const ServerConfig& config, const Gate& gate) {
  Pages pages{gate};
  if (!config.tiles.empty()) {
    auto tiles = Tiles::open(config.tiles);
    if (!tiles) return tiles.error();
    pages.tiles_ = std::move(*tiles);
  }
  for (const Overlay& overlay : config.overlays) {
    std::ifstream stream{overlay.file};
    std::string text{std::istreambuf_iterator<char>{stream}, {}};
    if (!stream && text.empty()) return Error{"cannot read the overlay " + overlay.file};
    if (codec::parse_json(text).is_discarded()) return Error{overlay.file + ": is not GeoJSON"};
    pages.overlays_.push_back({"/overlays/" + overlay.name, std::move(text)});
  }
  return pages;
}

HttpResponse Pages::respond(const HttpRequest& request) const {
  const std::string_view target = request.target;
  const std::string_view path = target.substr(0, target.find('?'));
  if (!gate_->is_own_host(request.host)) {
    return {HttpStatus::misdirected_request, media::kText,
            "the console answers to 127.0.0.1 and localhost only\n"};
  }
  if (request.method != HttpMethod::get && request.method != HttpMethod::head) {
    return {HttpStatus::method_not_allowed, media::kText, "only GET\n"};
  }
  if (const Asset* asset = asset_of(path)) {
    HttpResponse response{HttpStatus::ok, std::string{asset->type}, std::string{asset->gzip}};
    response.fields = {{"Content-Encoding", "gzip"}};
    // A file under /assets has a name made of its contents.
    if (path != "/") {
      response.fields.emplace_back("Cache-Control", "public, max-age=31536000, immutable");
    }
    return response;
  }
  const auto identity = gate_->identify(request.cookie, Gate::Time::clock::now());
  if (!identity) {
    return {HttpStatus::unauthorized, media::kJson,
            gate_->asks_for_token() ? R"({"error":"log in first","asks":"token"})"
                                    : R"({"error":"log in first","asks":"password"})"};
  }
  if (path == "/session") {
    return {HttpStatus::ok, media::kJson,
            codec::json_text({{"user", identity->user},
                              {"role", to_string(identity->role)},
                              {"login", gate_->asks_for_password()}})};
  }
  for (const Loaded& overlay : overlays_) {
    if (overlay.path == path) return {HttpStatus::ok, "application/geo+json", overlay.text};
  }
  if (auto found = tile(path)) return *std::move(found);
  return {HttpStatus::not_found, media::kText, "there is no such page\n"};
}

std::optional<HttpResponse> Pages::tile(std::string_view path) const {
  constexpr std::string_view kPrefix = "/tiles/";
  if (!tiles_ || path.substr(0, kPrefix.size()) != kPrefix) return std::nullopt;
  path.remove_prefix(kPrefix.size());
  std::array<unsigned, 3> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto end = path.find('/');
    const auto value = number(path.substr(0, end));
    if (!value || (end == std::string_view::npos) != (i + 1 == numbers.size())) return std::nullopt;
    numbers[i] = *value;
    if (end != std::string_view::npos) path.remove_prefix(end + 1);
  }
  auto found = tiles_->tile(numbers[0], numbers[1], numbers[2]);
  if (!found) return std::nullopt;
  return HttpResponse{HttpStatus::ok,
                      std::move(found->type),
                      std::move(found->bytes),
                      {{"Cache-Control", "private, max-age=3600"}}};
}

}  // namespace skein::console
