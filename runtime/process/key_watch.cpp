// SPDX-License-Identifier: Apache-2.0
#include "skein/process/key_watch.hpp"

#include <spdlog/spdlog.h>

#include <chrono>
#include <system_error>
#include <utility>
#include <vector>

#include "skein/identity/authority.hpp"
#include "skein/identity_desk/given.hpp"

namespace skein::process {
namespace {

constexpr std::chrono::milliseconds kPeriod{250};
/// Who has not heard of the new key yet is still understood for so long; who was revoked, too.
constexpr Duration kOldKeyFor = std::chrono::seconds{3};

}  // namespace

KeyWatch::KeyWatch(network::Node& node, identity::Identity identity, std::filesystem::path folder,
                   OnTold on_told, OnKey on_key)
    : node_{node},
      identity_{std::move(identity)},
      folder_{std::move(folder)},
      on_told_{std::move(on_told)},
      on_key_{std::move(on_key)},
      thread_{[this] { run(); }} {}

KeyWatch::~KeyWatch() {
  {
    const std::lock_guard lock{mutex_};
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void KeyWatch::run() {
  const bool has_authority =
      identity_.own().role == identity::Role::ground && identity_.own().node == kGroundStation;
  std::unique_lock lock{mutex_};
  while (!changed_.wait_for(lock, kPeriod, [this] { return ending_; })) {
    if (has_authority) {
      look_at_changes();
    } else {
      take_news();
    }
  }
}

void KeyWatch::begin_epoch() {
  node_.learn(identity_.revoked());
  node_.change_key(identity_.epoch_key(), kOldKeyFor);
  on_key_(identity_.revoked(), identity_.epoch_key(), kOldKeyFor);
  spdlog::info("the team has another key from now on, of epoch {}; revoked so far: {}",
               identity_.epoch_key().epoch, identity_.revoked().serials.size());
}

void KeyWatch::take_news() {
  while (const auto bytes = node_.take_key_news()) {
    const auto change = identity::key_change_from(*bytes);
    if (!change) {  // anybody may send it
      node_.count_forged_key_news();
      continue;
    }
    switch (identity_.take(*change)) {
      case identity::Changed::forged:
        node_.count_forged_key_news();
        break;
      case identity::Changed::taken:
        begin_epoch();
        if (const auto stored = identity_.store(); !stored) {
          spdlog::warn("the new key is not stored, and the next start is with the old one: {}",
                       stored.error().message);
        }
        break;
      case identity::Changed::revoked:
        if (said_.empty()) {
          said_ = "this node was revoked: the others hear it no more, and it hears nobody";
          spdlog::critical(said_);
        }
        break;
      default:
        break;
    }
  }
}

void KeyWatch::look_at_changes() {
  std::error_code failed;
  const auto written = std::filesystem::last_write_time(folder_ / identity::kChangesFile, failed);
  if (failed || written == changes_of_) return;
  auto again =
      identity::Identity::open(identity::KeyFolder::of(folder_), identity_desk::now_unix_s());
  const auto changes = identity::read_changes(folder_);
  if (!again || !changes) {
    const std::string trouble = !again ? again.error().message : changes.error().message;
    if (std::exchange(said_, trouble) != trouble) spdlog::warn(trouble);
    return;
  }
  changes_of_ = written;
  std::vector<network::KeyNews> news;
  for (const auto& [member, change] : *changes) {
    news.push_back({member, change.grant.epoch, to_bytes(change)});
  }
  const bool is_new = again->epoch_key().epoch != identity_.epoch_key().epoch;
  identity_ = std::move(*again);
  node_.tell(news);
  if (is_new) begin_epoch();
  on_told_(identity_.revoked());
}

}  // namespace skein::process
