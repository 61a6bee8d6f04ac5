// SPDX-License-Identifier: Apache-2.0
#include "skein/ardupilot/survey.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "can_link_parts.hpp"
#include "link_watch.hpp"
#include "parameter_check.hpp"
#include "remote_id_speaker.hpp"
#include "skein/ardupilot/airframe.hpp"
#include "skein/dronecan/node.hpp"
#include "skein/dronecan/tunnel.hpp"
#include "status_text.hpp"
#include "troubles.hpp"

namespace skein::ardupilot {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kAskPeriod = milliseconds{400};
constexpr Duration kWatchPatience = milliseconds{2500};
/// After the last reason not to arm, whether there is another.
constexpr Duration kReasonsWithin = milliseconds{1500};

/// Told where they are there; a firmware may lack them.
constexpr std::array<std::string_view, 3> kOthers{"FENCE_ENABLE", "ARMING_CHECK", "TKOFF_ALT"};
constexpr int kOthersAsked = 4;

}  // namespace

class Survey::Impl {
 public:
  Impl(std::unique_ptr<can::Bus> bus, const CanLinkParams& params, Instant now)
      : params_{params},
        bus_{std::move(bus)},
        begun_{now},
        watch_{link_ids(params, bus_->name()), now, kWatchPatience},
        parameters_{safety_questions(params.companion.vehicle, params.companion.system_id,
                                     params.companion.fence)},
        remote_id_{params.companion.remote_id, params.companion.vehicle.airframe,
                   params.companion.unix_us},
        encoder_{params.companion.system_id, mavlink::kComponentOnboardComputer},
        parser_{mavlink::parser_params(params.companion.signing, now)} {}

  bool step(Instant now) {
    receive(now);
    if (over_) return true;
    if (facts_.own_id_taken || (!facts_.heartbeat && now - begun_ >= kFoundWithin)) {
      return end(now);
    }
    if (now - begun_ < kListen) return false;
    if (!node_) {
      node_.emplace(node_params(params_), now);
      port_.emplace(tunnel_params(params_), now);
    }
    if (facts_.heartbeat && now >= ask_at_) {
      ask_at_ = now + kAskPeriod;
      mavlink::sign_at(params_.companion.signing, encoder_, parser_, now);
      ask(now);
    }
    if (facts_.heartbeat) {
      remote_id_.speak(params_.companion.system_id, now,
                       [this](const auto& message) { send(message); });
    }
    transmit(now);
    if (!facts_.heartbeat) return false;
    if (has_all(now) || now - found_at_ >= kAnsweredWithin) return end(now);
    return false;
  }
  [[nodiscard]] const can::Bus& bus() const { return *bus_; }
  [[nodiscard]] const AutopilotFacts& facts() const { return facts_; }

 private:
  void receive(Instant now) {
    while (const auto frame = bus_->receive()) {
      watch_.on_frame(*frame, now);
      if (!frame->error) ++facts_.frames;
      const auto header = dronecan::header_of(*frame);
      if (!header || header->source == 0) continue;
      if (header->source == params_.companion_node_id) {
        facts_.own_id_taken = true;
        continue;
      }
      nodes_.insert(header->source);
      // Before there is a node, its messages are put together all the same: HEARTBEAT may be there.
      const auto* transfer =
          node_ ? node_->on_frame(*frame, 0, now) : reassembler_.on_frame(*frame, 0, now);
      if (transfer == nullptr) continue;
      watch_.on_transfer(*transfer, now);
      on_transfer(*transfer, now);
    }
  }

  void on_transfer(const dronecan::Transfer& transfer, Instant now) {
    if (!dronecan::is<dronecan::Targetted>(transfer) || transfer.header.source != params_.node_id) {
      return;
    }
    const auto message = dronecan::decode<dronecan::Targetted>(transfer);
    if (!message || message->serial_id != params_.serial_id ||
        message->target_node != params_.companion_node_id) {
      return;
    }
    facts_.serial_heard = true;
    parser_.parse(message->buffer,
                  [this, now](const mavlink::Packet& packet) { on_packet(packet, now); });
  }

  void on_packet(const mavlink::Packet& packet, Instant now) {
    if (is_of_transmitter(packet, params_.companion.system_id)) {
      return remote_id_.on_packet(packet, now);
    }
    if (packet.component != mavlink::kComponentAutopilot) return;
    const auto heartbeat = mavlink::decode<mavlink::Heartbeat>(packet);
    if (heartbeat) watch_.on_heartbeat(packet.system, now);
    if (packet.system != params_.companion.system_id) return;
    if (heartbeat && !facts_.heartbeat) found_at_ = now;
    if (const auto fix = mavlink::decode<mavlink::GpsRawInt>(packet)) {
      remote_id_.on_place({fix->lat * 1e-7, fix->lon * 1e-7, fix->alt * 1e-3}, false);
    }
    if (facts_.take(packet, now)) return;
    if (const auto text = mavlink::decode<mavlink::Statustext>(packet)) {
      on_text(*text, now);
    } else if (const auto parameter = mavlink::decode<mavlink::ParamValue>(packet)) {
      const std::string name = mavlink::text_of(parameter->param_id);
      parameters_.on_value(name, parameter->param_value);
      facts_.parameters[name] = static_cast<double>(parameter->param_value);
    }
  }

  void on_text(const mavlink::Statustext& text, Instant now) {
    const std::string& whole = text_.add(text);
    if (!PreArmTexts::is_one(whole) || !StatusText::ends(text)) return;
    if (reasons_.add(PreArmTexts::reason_of(whole), now)) reason_at_ = now;
  }

  template <class Message>
  void send(const Message& message) {
    const auto bytes = encoder_.encode(message);
    (void)port_->write(bytes);
  }
  void command(mavlink::Command what, std::uint32_t param1) {
    mavlink::CommandLong c;
    c.command = static_cast<std::uint16_t>(what);
    c.param1 = static_cast<float>(param1);
    c.target_system = params_.companion.system_id;
    c.target_component = mavlink::kComponentAutopilot;
    send(c);
  }
  template <class Message>
  void want(const std::optional<Message>& had) {
    if (!had) command(mavlink::Command::request_message, Message::kDefinition.id);
  }
  void ask_parameter(std::string_view name) {
    send(mavlink::ParamRequestRead{.param_index = -1,
                                   .target_system = params_.companion.system_id,
                                   .target_component = mavlink::kComponentAutopilot,
                                   .param_id = mavlink::field_of<16>(name)});
  }

  void ask(Instant now) {
    if (!facts_.firmware) {
      command(mavlink::Command::request_message, mavlink::AutopilotVersion::kDefinition.id);
    }
    want(facts_.health);
    want(facts_.gnss);
    want(facts_.filter);
    want(facts_.time);
    want(facts_.landed);
    for (const std::string_view name : parameters_.due(now)) ask_parameter(name);
    for (const LimitParameter& limit : traits_of(params_.companion.vehicle.airframe).limits) {
      if (is_told(limit)) continue;
      ask_parameter(limit.name);
      if (!limit.older_name.empty()) ask_parameter(limit.older_name);
    }
    if (others_asked_ < kOthersAsked) {
      ++others_asked_;
      for (const std::string_view name : kOthers) {
        if (!facts_.parameters.contains(std::string{name})) ask_parameter(name);
      }
    }
    if (facts_.health && !facts_.prearm_good() && !reasons_asked_at_) {
      reasons_asked_at_ = now;
      command(mavlink::Command::run_prearm_checks, 0);
    }
  }

  [[nodiscard]] bool is_told(const LimitParameter& limit) const {
    return facts_.parameters.contains(std::string{limit.name}) ||
           facts_.parameters.contains(std::string{limit.older_name});
  }
  [[nodiscard]] bool has_all(Instant now) const {
    const auto limits = traits_of(params_.companion.vehicle.airframe).limits;
    const bool told = parameters_.all_told() && others_asked_ == kOthersAsked &&
                      std::ranges::all_of(limits, [this](const auto& l) { return is_told(l); });
    const bool reasons =
        facts_.prearm_good() ||
        (reasons_asked_at_ && now - std::max(*reasons_asked_at_, reason_at_) >= kReasonsWithin);
    return facts_.firmware && facts_.health && facts_.gnss && facts_.filter && facts_.time &&
           facts_.landed && told && reasons && (!remote_id_.exists() || !remote_id_.why_not(now));
  }

  void transmit(Instant now) {
    port_->step(*node_, now);
    node_->step(now);
    for (auto frames = node_->front(); !frames.empty(); frames = node_->front()) {
      (void)bus_->send(frames);
      node_->pop();
    }
    bus_->flush();
  }

  bool end(Instant now) {
    over_ = true;
    facts_.nodes.assign(nodes_.begin(), nodes_.end());
    facts_.node_heard = nodes_.contains(params_.node_id);
    if (!facts_.heartbeat) facts_.trouble = watch_.trouble(now);
    if (!facts_.heartbeat && parser_.statistics().bad_signature > 0) {
      facts_.trouble = AutopilotNotice{AutopilotNews::not_signed};
    }
    if (facts_.heartbeat) facts_.safety = parameters_.tested();
    if (remote_id_.exists()) facts_.remote_id = remote_id_.why_not(now).value_or("");
    for (const auto& reason : reasons_.texts()) facts_.pre_arm.push_back(reason.text);
    return true;
  }

  CanLinkParams params_;
  std::unique_ptr<can::Bus> bus_;
  Instant begun_;
  LinkWatch watch_;
  ParameterCheck parameters_;
  RemoteIdSpeaker remote_id_;
  mavlink::Encoder encoder_;
  mavlink::Parser parser_;
  dronecan::Reassembler reassembler_;
  std::optional<dronecan::Node> node_;  ///< once it is sure of its id
  std::optional<dronecan::TunnelPort> port_;
  std::set<std::uint8_t> nodes_;
  PreArmTexts reasons_;
  StatusText text_;
  std::optional<Instant> reasons_asked_at_;
  Instant reason_at_{Instant::min()};
  Instant ask_at_{Instant::min()};
  Instant found_at_;
  int others_asked_ = 0;
  bool over_ = false;
  AutopilotFacts facts_;
};

Survey::Survey(std::unique_ptr<can::Bus> bus, const CanLinkParams& params, Instant now)
    : impl_{std::make_unique<Impl>(std::move(bus), params, now)} {}
Survey::~Survey() = default;
bool Survey::step(Instant now) { return impl_->step(now); }
const can::Bus& Survey::bus() const { return impl_->bus(); }
const AutopilotFacts& Survey::facts() const { return impl_->facts(); }

}  // namespace skein::ardupilot
