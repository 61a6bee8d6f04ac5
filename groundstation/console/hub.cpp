// SPDX-License-Identifier: Apache-2.0
#include "hub.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

#include "skein/base/text.hpp"
#include "skein/codec/json_text.hpp"

namespace skein::console {
namespace {

using codec::Json;

constexpr std::size_t kRequestsMax = 256;
constexpr int kPublicationsMax = 4;
constexpr std::size_t kNameMax = 64;    ///< bytes of a user's name, for a log
constexpr std::size_t kLoginsMax = 16;  ///< that wait, of as many addresses; each takes some 0.1 s

}  // namespace

Hub::Hub(const ServerConfig& config, std::function<void()> on_request, Post post, Post post_login)
    : config_{config},
      on_request_{std::move(on_request)},
      post_{std::move(post)},
      post_login_{std::move(post_login)},
      gate_{config.log_in != nullptr, config.token, !config.certificate.empty(),
            config.observer_token},
      run_{random_hex(8)},
      requests_{kRequestsMax} {}

Result<void> Hub::open() {
  auto pages = Pages::open(config_, gate_);
  if (!pages) return pages.error();
  pages_.emplace(std::move(*pages));
  return {};
}

bool Hub::submit(Server::Request request) {
  {
    const std::lock_guard lock{requests_mutex_};
    if (!requests_.push(std::move(request))) return false;
  }
  on_request_();
  return true;
}

std::optional<Server::Request> Hub::next() {
  const std::lock_guard lock{requests_mutex_};
  return requests_.pop();
}

void Hub::publish_soon(double time_s, Sections sections) {
  if (publications_ >= kPublicationsMax) return;
  ++publications_;
  post([this, time_s, sections = std::move(sections)]() mutable {
    --publications_;
    board_.publish(time_s, std::move(sections));
    tell_all();
  });
}

void Hub::append(std::vector<std::string> events) {
  board_.append(std::move(events));
  tell_all();
}

void Hub::restart(std::uint64_t next_seq, const std::string& series) {
  board_.truncate(next_seq);
  const std::string history = board_.history(series);
  for (Client* client : std::vector<Client*>{clients_.begin(), clients_.end()}) {
    client->on_restart(history, next_seq);
  }
}

void Hub::end(const std::string& text, const std::shared_ptr<void>& sent) {
  for (Client* client : std::vector<Client*>{clients_.begin(), clients_.end()}) {
    client->on_end(text, sent);
  }
}

void Hub::live(const Server::LiveRecord& record) {
  auto channel = std::find_if(channels_.begin(), channels_.end(),
                              [&](const auto& known) { return known.topic == record.topic; });
  const std::vector<LiveClient*> all{live_clients_.begin(), live_clients_.end()};
  if (channel == channels_.end()) {
    channels_.push_back({static_cast<std::uint32_t>(channels_.size() + 1), record.topic,
                         std::string{record.schema_name}, std::string{record.schema}});
    channel = std::prev(channels_.end());
    for (LiveClient* client : all) client->on_channel(*channel);
  }
  for (LiveClient* client : all) client->on_record(channel->id, record);
}

void Hub::report(Server::MachineReport report) {
  machine_pages_.report(std::move(report), std::chrono::steady_clock::now());
}

void Hub::join(Client& client) {
  clients_.insert(&client);
  watched_ = true;
}

void Hub::leave(Client& client) {
  clients_.erase(&client);
  watched_ = !clients_.empty();
}

void Hub::join(LiveClient& client) {
  live_clients_.insert(&client);
  live_watched_ = true;
}

void Hub::leave(LiveClient& client) {
  live_clients_.erase(&client);
  live_watched_ = !live_clients_.empty();
}

Result<void> Hub::log_in(const std::string& address, std::string user, std::string password,
                         std::function<void(std::optional<Identity>)> done) {
  if (gate_.asks_for_token()) {
    // It is not guessed; who tries to, from this machine, must not make the operator wait.
    done(gate_.check(password));
    return {};
  }
  const auto wait = login_waits_.wait(address, std::chrono::steady_clock::now());
  if (wait) {
    return Error{fmt::format("too many wrong passwords; try again in {} s", wait->count())};
  }
  if (logins_.size() >= kLoginsMax || !logins_.insert(address).second) {
    return Error{"too many log in at once; try again"};
  }
  post_login_([this, address, user = std::move(user), password = std::move(password),
               done = std::move(done)]() mutable {
    std::optional<Identity> identity;
    if (const auto role = config_.log_in(user, password)) identity = Identity{user, *role};
    post([this, address, user = std::move(user), identity = std::move(identity),
          done = std::move(done)] {
      logins_.erase(address);
      if (identity) {
        login_waits_.right(address);
      } else {
        refused_login(address, user);
      }
      done(identity);
    });
  });
  return {};
}

void Hub::refused_login(const std::string& address, const std::string& user) {
  const auto now = std::chrono::steady_clock::now();
  const int in_a_row = login_waits_.wrong(address, now);
  const auto wait = login_waits_.wait(address, now).value_or(std::chrono::seconds{0});
  if (config_.on_refused_login) {
    config_.on_refused_login({as_text(user, kNameMax), address, in_a_row, wait});
  }
}

std::string Hub::log_out(std::string_view cookies) {
  const auto who = gate_.identify(cookies, std::chrono::steady_clock::now());
  std::string field = gate_.dismiss(cookies);
  if (who && config_.on_logout && !gate_.has_session(who->user)) config_.on_logout(who->user);
  tell_of_log_out();
  return field;
}

void Hub::expel(const std::string& user) {
  gate_.dismiss_all(user);
  tell_of_log_out();
}

void Hub::tell_of_log_out() {
  for (Client* client : std::vector<Client*>{clients_.begin(), clients_.end()}) {
    client->on_log_out();
  }
  for (LiveClient* client : std::vector<LiveClient*>{live_clients_.begin(), live_clients_.end()}) {
    client->on_log_out();
  }
}

std::string Hub::hello(const Identity& identity) const {
  Json hello = codec::parse_own_json(config_.hello);
  hello["type"] = "hello";
  hello["run"] = run_;
  hello["role"] = to_string(identity.role);
  hello["user"] = identity.user;
  hello["tiles"] =
      pages_->tiles() ? codec::parse_own_json(pages_->tiles()->description()) : Json(nullptr);
  hello["overlays"] = Json::array();
  for (const Overlay& overlay : config_.overlays) {
    hello["overlays"].push_back({{"name", overlay.name}, {"url", "/overlays/" + overlay.name}});
  }
  hello["groups"] = Json::array();
  for (const VehicleGroup& group : config_.groups) {
    hello["groups"].push_back({{"name", group.name}, {"vehicles", group.vehicles}});
  }
  return codec::json_text(hello);
}

void Hub::tell_all() {
  for (Client* client : std::vector<Client*>{clients_.begin(), clients_.end()}) client->on_news();
}

}  // namespace skein::console
