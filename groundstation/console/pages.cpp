// SPDX-License-Identifier: Apache-2.0
#include "pages.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "assets.hpp"

namespace skein::console {
namespace {

namespace http = boost::beast::http;

constexpr std::string_view kPolicy =
    "default-src 'self'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'";
constexpr std::string_view kJson = "application/json";
constexpr std::string_view kText = "text/plain; charset=utf-8";

boost::beast::string_view beast_view(std::string_view text) { return {text.data(), text.size()}; }

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

HttpResponse answer(const HttpRequest& request, http::status status, std::string_view type,
                    std::string body) {
  HttpResponse response{status, request.version()};
  response.set(http::field::server, "skein");
  response.set(http::field::content_type, beast_view(type));
  response.set("Content-Security-Policy", beast_view(kPolicy));
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  response.set("Cross-Origin-Opener-Policy", "same-origin");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  response.set(http::field::cache_control, "no-store");
  response.keep_alive(request.keep_alive());
  response.body() = std::move(body);
  response.prepare_payload();
  return response;
}

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
    if (!nlohmann::json::accept(text)) return Error{overlay.file + ": is not GeoJSON"};
    pages.overlays_.push_back({"/overlays/" + overlay.name, std::move(text)});
  }
  return pages;
}

HttpResponse Pages::respond(const HttpRequest& request) const {
  const std::string_view target = view(request.target());
  const std::string_view path = target.substr(0, target.find('?'));
  if (!gate_->is_own_host(view(request[http::field::host]))) {
    return answer(request, http::status::misdirected_request, kText,
                  "the console answers to 127.0.0.1 and localhost only\n");
  }
  if (request.method() != http::verb::get && request.method() != http::verb::head) {
    return answer(request, http::status::method_not_allowed, kText, "only GET\n");
  }
  if (const Asset* asset = asset_of(path)) {
    HttpResponse response =
        answer(request, http::status::ok, asset->type, std::string{asset->gzip});
    response.set(http::field::content_encoding, "gzip");
    // A file under /assets has a name made of its contents.
    if (path != "/") {
      response.set(http::field::cache_control, "public, max-age=31536000, immutable");
    }
    return response;
  }
  const auto identity =
      gate_->identify(view(request[http::field::cookie]), Gate::Time::clock::now());
  if (!identity) {
    return answer(request, http::status::unauthorized, kJson, R"({"error":"log in first"})");
  }
  if (path == "/session") {
    const nlohmann::json who{{"user", identity->user},
                             {"role", to_string(identity->role)},
                             {"login", gate_->asks_for_password()}};
    return answer(request, http::status::ok, kJson, who.dump());
  }
  for (const Loaded& overlay : overlays_) {
    if (overlay.path == path) {
      return answer(request, http::status::ok, "application/geo+json", overlay.text);
    }
  }
  if (auto found = tile(request, path)) return *std::move(found);
  return answer(request, http::status::not_found, kText, "there is no such page\n");
}

std::optional<HttpResponse> Pages::tile(const HttpRequest& request, std::string_view path) const {
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
  HttpResponse response = answer(request, http::status::ok, found->type, std::move(found->bytes));
  response.set(http::field::cache_control, "private, max-age=3600");
  return response;
}

}  // namespace skein::console
