// SPDX-License-Identifier: Apache-2.0
#include "station_network.hpp"

#include <spdlog/spdlog.h>

#include <utility>

#include "skein/identity/identity.hpp"

namespace skein::groundstation {

Result<std::unique_ptr<StationNetwork>> StationNetwork::open(
    const configuration::NetworkConfig& config, const process::NodeStart& start,
    process::Wake& wake) {
  std::unique_ptr<StationNetwork> made{
      new StationNetwork{config, {start.self, start.instance, std::nullopt, start.seal}}};
  made->node_ = process::node_config(config, start, [&wake] { wake.notify(); });
  made->node_.isolated = config.isolated;
  auto ear = network::Node::open(made->node_);
  if (!ear) return ear.error();
  made->ear_ = std::move(ear).value();
  made->silent_ = made->is_one_of_several();
  return made;
}

Result<InstanceId> StationNetwork::speak(std::optional<InstanceId> newest) {
  const auto as = process::start_voice(config_, start_, newest);
  if (!as) return as.error();
  const std::lock_guard lock{mutex_};
  network::NodeConfig voice = node_;
  voice.self = kGroundStation;
  voice.instance = as->instance;
  if (as->start) voice.seal = network::SealConfig{*as->start, node_.seal->key};
  voice.overhears = false;
  voice.heeds = [](const mission::Message&) { return false; };  // the ear hears
  voice.on_received = {};
  voice_.reset();
  auto opened = network::Node::open(voice);
  if (!opened) {
    silent_ = true;  // nobody would heed what the ear says
    return opened.error();
  }
  voice_ = std::move(opened).value();
  silent_ = false;
  return as->instance;
}

void StationNetwork::fall_silent() {
  silent_ = true;
  std::unique_ptr<network::Node> gone;
  {
    const std::lock_guard lock{mutex_};
    gone = std::move(voice_);
  }
}

void StationNetwork::note(InstanceId other) const {
  if (!start_.seal || config_.keys.empty()) return;
  const auto noted =
      identity::note_start(identity::KeyFolder::of(config_.keys), identity::start_number(other));
  if (!noted) spdlog::warn("the other ground station's start: {}", noted.error().message);
}

bool StationNetwork::publish(const mission::Message& message) {
  return !silent_ && voice()->publish(message);
}

void StationNetwork::on_key(const identity::RevocationList& revoked, const seal::EpochKey& key,
                            Duration old_for) {
  if (!is_one_of_several()) return;
  const std::lock_guard lock{mutex_};
  if (node_.seal) node_.seal->key = key;
  if (node_.sign) (void)node_.sign->verifier.learn(revoked);
  if (!voice_) return;
  voice_->learn(revoked);
  voice_->change_key(key, old_for);
}

}  // namespace skein::groundstation
