// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/ground_process.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "commanding.hpp"
#include "ground_start.hpp"
#include "input_rules.hpp"
#include "search_words.hpp"
#include "skein/base/stations.hpp"
#include "skein/codec/codec.hpp"
#include "skein/codec/json_text.hpp"
#include "skein/configuration/setup_params.hpp"
#include "skein/console/team_fence.hpp"
#include "skein/console/team_preflight.hpp"
#include "skein/console/team_state.hpp"
#include "skein/groundstation/agency_desk.hpp"
#include "skein/groundstation/area_desk.hpp"
#include "skein/groundstation/audit.hpp"
#include "skein/groundstation/console_desk.hpp"
#include "skein/groundstation/control_socket.hpp"
#include "skein/groundstation/decision_desk.hpp"
#include "skein/groundstation/fence_desk.hpp"
#include "skein/groundstation/formation_desk.hpp"
#include "skein/groundstation/health_report.hpp"
#include "skein/groundstation/line_reader.hpp"
#include "skein/groundstation/operator_keys.hpp"
#include "skein/groundstation/prompt.hpp"
#include "skein/groundstation/recorder.hpp"
#include "skein/groundstation/return_desk.hpp"
#include "skein/groundstation/revocations.hpp"
#include "skein/groundstation/route_desk.hpp"
#include "skein/groundstation/several.hpp"
#include "skein/groundstation/site_desk.hpp"
#include "skein/groundstation/views.hpp"
#include "skein/identity_desk/given.hpp"
#include "skein/mission/ground_node.hpp"
#include "skein/network/node.hpp"
#include "skein/process/close_limit.hpp"
#include "skein/process/host.hpp"
#include "skein/process/journal.hpp"
#include "skein/process/key_watch.hpp"
#include "skein/process/log.hpp"
#include "skein/process/mission_clock.hpp"
#include "skein/process/mission_network.hpp"
#include "skein/process/service.hpp"
#include "skein/process/shutdown.hpp"
#include "skein/process/wake.hpp"
#include "skein/version/version.hpp"
#include "skein/wording/wording.hpp"

namespace skein::groundstation {
namespace {

constexpr Duration kStepPeriod = std::chrono::milliseconds{50};
constexpr Duration kStepSpacing = std::chrono::milliseconds{20};  // telemetry comes all the time
constexpr Duration kReportPeriod = std::chrono::seconds{1};
constexpr Duration kPlannedForWatchers = std::chrono::seconds{1};
constexpr Duration kFlushPeriod = std::chrono::seconds{1};
constexpr int kConsoleLinesPerStep = 8;  // so that a flood cannot keep the loop from its deadlines
constexpr int kMessagesPerStep = 1000;   // nor one of messages
constexpr std::chrono::seconds kLookAgain{1};
constexpr std::string_view kJsonPrefix = "json ";

mission::GroundNodeConfig node_config(const configuration::GroundConfig& config,
                                      InstanceId instance, const OperatorKeys& keys) {
  mission::GroundNodeConfig node;
  node.instance = instance;
  node.setup = configuration::setup_params(config, {version(), codec::wire_versions()});
  mission::GroundAgentConfig& agent = node.agent;
  agent.expected = config.vehicles;
  agent.approve = [&keys](mission::Authorisation& grant) {
    return keys.approve(grant, std::chrono::steady_clock::now());
  };
  node.hazards = config.hazards;
  node.searches.vehicles = config.planes;
  node.detections = detections_config(config);
  for (const auto& decision : config.operator_decisions) {
    agent.decisions.push_back({.site = decision.site,
                               .grant = decision.grant,
                               .reaction = decision.reaction,
                               .not_before = decision.not_before});
  }
  if (config.formation.planes) {
    node.tracks = track_ground(config.formation, config.planes, config.hazards);
  } else {
    node.formation = formation_ground(config.formation, config.vehicles);
  }
  node.fence = node.formation.fence = node.tracks.fence = config.fence;
  return node;
}

void print(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
}

constexpr const char* kConsole = "console";

/// Who gave a line.
struct Asker {
  std::string who;
  std::string from;       ///< prompt, command line, console
  bool may_order = true;  ///< otherwise may only look
};

std::string network_text(std::optional<std::uint8_t> epoch) {
  return epoch ? fmt::format("network: sealed, epoch {}\n", *epoch)
               : "network: in clear, on this machine alone\n";
}

std::string keys_text(const OperatorKeys& keys) {
  if (!keys.are_needed()) return "";
  const auto signs = keys.machine_operator();
  return signs ? fmt::format("signs here: {}\n", *signs)
               : "signs here: nobody; 'skein-ground unlock --operator NAME' changes that\n";
}

/// Said by an operator's word: a new start of this process goes on with it.
bool must_outlast(const mission::Message& message) {
  return std::holds_alternative<mission::Authorisation>(message) ||
         std::holds_alternative<mission::Command>(message) ||
         std::holds_alternative<mission::SiteReport>(message) ||
         std::holds_alternative<mission::HazardReport>(message) ||
         std::holds_alternative<mission::FenceOrder>(message) ||
         std::holds_alternative<mission::Route>(message) ||
         std::holds_alternative<formation::Change>(message);
}

/// The answer for programs: one JSON object.
std::string json_of(const Answer& answer) {
  codec::Json json{{"done", answer.done}, {"text", answer.text}};
  json["data"] = codec::parse_own_json(answer.data);
  if (json["data"].is_discarded()) json["data"] = nullptr;
  return codec::json_text(json, 2) + "\n";
}

/// Carries messages and lines to the node, and its messages, events and requests away.
class GroundLoop {
 public:
  GroundLoop(const configuration::GroundConfig& config, const MissionOrigin& origin,
             std::string operator_name, const process::MissionClock& clock,
             const process::Shutdown& shutdown, StationNetwork& network, InstanceId instance,
             process::Wake& wake, Recorder recorder, OperatorKeys& keys, Revocations& revocations,
             mission::GroundNode& node, FormationDesk formation,
             std::unique_ptr<ControlSocket> control, ConsoleDesk console, Audit audit)
      : origin_{origin},
        operator_name_{operator_name},
        own_operator_{std::move(operator_name)},
        clock_{clock},
        shutdown_{shutdown},
        network_{network},
        commanding_{config.command, instance, network, node, clock.now()},
        wake_{wake},
        recorder_{std::move(recorder)},
        decisions_{config.operator_decisions},
        keys_{keys},
        revocations_{revocations},
        node_{node},
        formation_{std::move(formation)},
        sites_{config, origin, node},
        routes_{node},
        fence_{node, origin_},
        returns_{node},
        areas_{node, clock.epoch_unix_ns()},
        control_{std::move(control)},
        console_{std::move(console)},
        agencies_{config, origin},
        audit_{std::move(audit)},
        recording_folder_{config.recording_folder},
        among_machines_{process::among_machines(config.network)} {}

  void run() {
    LineReader prompt{STDIN_FILENO, [this] { wake_.notify(); }};
    node_.set_revoked(revocations_.vehicles());
    while (!stopping_) {
      const bool heard_all = take_messages();
      const Instant now = clock_.now();
      process::log_troubles(network_.ear());
      take_lines(prompt, now);
      while (const auto marker = agencies_.next_marker(now)) {
        if (commanding_.is_commanding()) node_.propose_from_outside(*marker, now);
      }
      while (auto seen = agencies_.next_aircraft(now)) node_.on_aircraft(*std::move(seen), now);
      if (speak_.exchange(false)) {
        node_.speak();
        take_revocations(now);
      }
      if (const auto notice =
              commanding_.on_timeout([&](const auto& e) { tell_of(e, now); }, now)) {
        const bool nobody = commanding_.desk().nobody_commands(now);
        spdlog::log(nobody ? spdlog::level::warn : spdlog::level::info, *notice);
      }
      node_.on_timeout(now);
      if (commanding_.is_commanding()) {
        formation_.on_timeout(now);
      } else if (commanding_.desk().newest()) {
        formation_.leave_script();
      }
      hand_out(now);
      report(now);
      steps_.fetch_add(1, std::memory_order_relaxed);
      const Instant soonest = now + kStepSpacing;
      clock_.sleep_until(soonest);
      if (!heard_all) continue;
      wake_.wait_until(
          clock_.steady_time_of(std::clamp(node_.next_timeout(), soonest, now + kStepPeriod)));
    }
    recorder_.flush();
    const Instant now = clock_.now();
    const std::string summary = summary_text(console_.picture(), node_.fleet());
    spdlog::info("the mission as it was left: {}", wording::one_line(summary));
    console_.end(node_.fleet(), {audit_.json(), areas_.json(now), commanding_.desk().json(now)},
                 summary, now);
    const auto since_1970 =
        std::chrono::nanoseconds{clock_.epoch_unix_ns()} + now.time_since_epoch();
    const auto closed =
        audit_.close(now, std::chrono::floor<std::chrono::seconds>(since_1970).count());
    if (!closed) spdlog::error("the audit log: {}", closed.error().message);
  }
  /// From another thread: who is in that list is out, and everybody is spoken to, so that the
  /// others hear of it.
  void on_revoked(const identity::RevocationList& revoked) {
    keys_.learn(revoked);
    revocations_.look();
    speak_ = true;
    wake_.notify();
  }
  /// From another thread: grows with every step.
  [[nodiscard]] std::uint64_t steps() const { return steps_.load(std::memory_order_relaxed); }
  /// From another thread.
  void stop() {
    stopping_ = true;
    wake_.notify();
  }

 private:
  /// False where more wait: lines, repeats and decisions come first.
  bool take_messages() {
    for (int i = 0; i < kMessagesPerStep; ++i) {
      const auto received = commanding_.next(clock_.now());
      if (!received) return true;
      const Instant now = clock_.now();  // never before it was sent, or its sender's clock is ahead
      recorder_.write(received->message, received->sender, now);
      if (!node_.on_message(received->message, received->sender, now)) continue;
      console_.on_message(received->message, received->sender, now);
    }
    return false;
  }

  void take_lines(LineReader& prompt, Instant now) {
    while (const auto line = prompt.next()) {
      const Answer given = answer(*line, {operator_name_, "prompt"}, now);
      print((given.done ? "" : "error: ") + given.text);
    }
    while (const auto request = control_ ? control_->next() : std::nullopt) {
      if (const auto unlock = unlock_in(request->line)) {
        request->reply(answer(*unlock, now));
        continue;
      }
      const bool wants_json = request->line.rfind(kJsonPrefix, 0) == 0;
      Answer given = answer(wants_json ? request->line.substr(kJsonPrefix.size()) : request->line,
                            {operator_name_, "command line"}, now);
      if (wants_json) given.text = json_of(given);
      request->reply(given);
    }
    for (int i = 0; i < kConsoleLinesPerStep; ++i) {
      const auto line = console_.next();
      if (!line) break;
      const Asker asker{line->user, kConsole, line->may_order};
      const Result<Input> asked =
          line->order.empty() ? parse_input(line->line) : read_order(line->order);
      // The audit has the words of what could not be read, too.
      const std::string words = line->order.empty() ? line->line : asked ? "" : line->order;
      const Answer given = answer(asked, words, asker, now);
      line->reply(given.done, given.text, given.data);
    }
  }

  /// From now on that operator decides at the prompt and the command line; or nobody signs there.
  Answer answer(const Unlock& asked, Instant now) {
    const bool locks = asked.name.empty();
    const std::string line = locks ? "lock" : "unlock " + asked.name;
    Answer given{true, "locked: nobody signs at the prompt and the command line\n"};
    const std::string who = locks ? operator_name_ : asked.name;
    if (locks) {
      keys_.lock_machine();
      operator_name_ = own_operator_;
    } else if (const auto unlocked = keys_.unlock_machine(asked.name, asked.password); !unlocked) {
      given = refusal(unlocked.error());
    } else {
      operator_name_ = asked.name;
      given.text = asked.name + " decides and signs at the prompt and the command line\n";
    }
    note({now, who, "command line", line, given.done, given.text, given.in_part});
    return given;
  }

  /// What was decided beside this process, by who has the mission's authority.
  void take_revocations(Instant now) {
    node_.set_revoked(revocations_.vehicles());
    for (const identity::Certificate& one : revocations_.take_new()) {
      if (one.role == identity::Role::op) {
        console_.expel(one.name);
        if (operator_name_ == one.name) operator_name_ = own_operator_;
      }
      note({now, "the mission's authority", "keys", "revoke " + holder_of(one), true,
            fmt::format("certificate {} is out\n", one.serial.value)});
    }
  }

  Answer answer(const std::string& line, const Asker& asker, Instant now) {
    return answer(parse_input(line), line, asker, now);
  }

  /// What came of what somebody asked, in a `line` or without one. Orders and decisions are noted.
  Answer answer(const Result<Input>& input, std::string line, const Asker& asker, Instant now) {
    if (line.empty() && input) line = line_of(*input);
    const char* not_here = input && asker.from == kConsole ? why_not_on_console(*input) : nullptr;
    // Before it is given: what it asks of whom is told by then.
    const std::string ends = input ? ends_search_text(node_.searches(), *input) : "";
    if (input && not_here == nullptr && only_looks(*input)) {
      Answer seen = look(*input, asker, now);
      if (seen.done) seen.text += ends;
      return seen;
    }
    Answer given = !input                ? refusal(input.error())
                   : not_here != nullptr ? Answer{false, not_here}
                   : !asker.may_order    ? Answer{false, "an observer gives no orders\n"}
                                         : order(*input, asker, now);
    if (given.done || given.in_part) given.text += ends;
    // What an observer tries would only push the orders out of sight.
    if (asker.may_order) {
      note({now, asker.who, asker.from, std::move(line), given.done, given.text, given.in_part});
    }
    return given;
  }

  Answer look(const Input& input, const Asker& asker, Instant now) {
    if (const auto* view = std::get_if<View>(&input)) {
      return {true, text_of(*view, now), data_of(*view, now)};
    }
    if (const auto* of = std::get_if<PreflightOf>(&input)) {
      return preflight_answer(node_.fleet(), of->vehicle, now);
    }
    if (const auto* of = std::get_if<StatusOf>(&input)) {
      return console_.status_of(of->vehicle, node_.fleet(), now);
    }
    if (const auto* preview = std::get_if<ReturnPreview>(&input)) {
      return returns_.answer(*preview, now);
    }
    // What is planned takes a while, and who only watches keeps no operator waiting with it.
    if (!asker.may_order && now < std::exchange(next_for_watchers_, now + kPlannedForWatchers)) {
      return {false, "others who watch have just tried something: ask again in a second\n"};
    }
    if (const auto* preview = std::get_if<Formation>(&input)) return formed(*preview, now);
    if (const auto* preview = std::get_if<NewSite>(&input)) return sites_.answer(*preview, "", now);
    if (const auto* preview = std::get_if<NewFence>(&input)) return fence_.answer(*preview, now);
    if (const auto* preview = std::get_if<RoutesFromFile>(&input)) {
      return routes_.answer(*preview, now);
    }
    if (const auto* preview = std::get_if<SearchArea>(&input)) return areas_.answer(*preview, now);
    if (const auto* preview = std::get_if<NewHazard>(&input)) return areas_.answer(*preview, now);
    return {true, ""};
  }

  Answer order(const Input& input, const Asker& asker, Instant now) {
    if (auto watches = commanding_.why_not(input, now)) return *std::move(watches);
    if (const auto* take = std::get_if<TakeCommand>(&input)) {
      return commanding_.answer(*take, asker.who, now);
    }
    if (const auto* over = std::get_if<HandOver>(&input)) {
      return commanding_.answer(*over, asker.who, now);
    }
    if (const auto* decision = std::get_if<Decision>(&input)) {
      return decision_answer(*decision, node_.agent(), asker.who, now);
    }
    if (const auto* back = std::get_if<TakeBack>(&input)) {
      return decision_answer(*back, node_.agent(), asker.who, now);
    }
    if (const auto* order = std::get_if<Order>(&input)) {
      const auto given = node_.command(order->vehicle, order->kind, now);
      if (order->vehicle != kGroundStation) return answer_to(given);
      return told_all(given, node_.fleet(),
                      [&](VehicleId one) { return node_.why_not_told(one, order->kind); });
    }
    if (const auto* several = std::get_if<OrderToSeveral>(&input)) {
      return tell_each(*several,
                       [&](VehicleId one) { return node_.command(one, several->kind, now); });
    }
    if (const auto* hazard = std::get_if<NewHazard>(&input)) return areas_.answer(*hazard, now);
    if (const auto* search = std::get_if<SearchArea>(&input)) return areas_.answer(*search, now);
    if (const auto* gone = std::get_if<WithdrawHazard>(&input)) {
      return areas_.answer(*gone, now);
    }
    if (const auto* fence = std::get_if<NewFence>(&input)) return fence_.answer(*fence, now);
    if (const auto* site = std::get_if<NewSite>(&input))
      return sites_.answer(*site, asker.who, now);
    if (const auto* file = std::get_if<SitesFromFile>(&input)) return sites_.answer(*file, now);
    if (const auto* site = std::get_if<WithdrawSite>(&input)) {
      return sites_.answer(*site, asker.who, now);
    }
    if (const auto* routes = std::get_if<RoutesFromFile>(&input)) {
      return routes_.answer(*routes, now);
    }
    if (const auto* off = std::get_if<CallOffRoutes>(&input)) return routes_.answer(*off, now);
    if (const auto* proposal = std::get_if<ProposalAnswer>(&input)) {
      return sites_.answer(*proposal, asker.who, now);
    }
    if (const auto* seen = std::get_if<Acknowledge>(&input)) {
      return console_.answer(*seen, asker.who, now);
    }
    if (const auto* formation = std::get_if<Formation>(&input)) return formed(*formation, now);
    if (const auto* record = std::get_if<Record>(&input)) return record_into(*record);
    if (std::holds_alternative<Wait>(input)) return {false, "'wait' is for scripts\n"};
    shutdown_.request();
    return {true, ""};
  }

  Answer record_into(const Record& order) {
    const bool ends = order.folder.empty();
    if (const auto done = ends ? recorder_.end() : recorder_.begin(order.folder); !done) {
      return refusal(done.error());
    }
    return {true, ends ? "ended\n" : "recording into " + order.folder + "\n"};
  }

  Answer formed(const Formation& order, Instant now) {
    auto outcome = formation_.answer(order, now);
    if (!outcome) return refusal(outcome.error());
    return {true, std::move(outcome->text), std::move(outcome->data)};
  }

  void note(Audit::Entry entry) {
    const auto noted = audit_.add(std::move(entry));
    const Audit::Entry& newest = audit_.newest();
    if (newest.done) {
      spdlog::info("{} ({}): {}", newest.who, newest.from, newest.line);
    } else {
      spdlog::warn("{} ({}): {}: {}{}", newest.who, newest.from, newest.line, outcome_word(newest),
                   newest.text);
    }
    if (!noted) {
      spdlog::error("the audit log: {}", noted.error().message);
    }
  }

  [[nodiscard]] std::string text_of(View view, Instant now) const {
    switch (view) {
      case View::help:
        return help_text();
      case View::status:
        return "mission time " + wording::moment_text(now, clock_.epoch_unix_ns()) + "\n" +
               console::team_text(console::team_state(
                   node_.fleet(), {commanding_.desk().nobody_commands(now)}, now)) +
               fleet_table(node_.fleet().vehicles(), now) + routes_.status_text(now) +
               (commanding_.desk().is_one_of_several() ? commanding_.desk().text(now) + "\n" : "") +
               network_text(network_.ear().epoch()) + keys_text(keys_) + revocations_.text();
      case View::sites:
        return sites_text(console_.picture());
      case View::pending:
        return pending_text(node_.agent().authorisations(), console_.picture(), node_.fleet(),
                            origin_, clock_.epoch_unix_ns(), now);
      case View::places:
        return formation_.places_table(now);
      case View::coalitions:
        return coalitions_text(console_.picture());
      case View::hazards:
        return areas_.hazards_text();
      case View::audit:
        return audit_.text();
      case View::command:
        return commanding_.desk().text(now) + "\n";
      case View::console:
        return console_.address_text();
      case View::proposals:
        return sites_.proposals_text();
      case View::alarms:
        return console::alarms_text(console_.alarms(), now);
      case View::routes:
        return routes_.text(now);
      case View::fence:
        return console::fence_text(console_.picture(), node_.fleet());
      case View::search:
        return areas_.text(now);
      case View::preflight:
        return console::preflight_text(console::team_preflight(node_.fleet(), now), now);
      case View::links:
      case View::wind:
      case View::traffic:
        return console_.text(view, node_.fleet(), now);
    }
    return "";
  }

  [[nodiscard]] std::string data_of(View view, Instant now) {
    if (view == View::audit) return audit_.json();
    if (view == View::search) return areas_.json(now);
    if (view == View::command) return commanding_.desk().json(now);
    const auto section = section_of(view);
    return section ? console_.section(*section, node_.fleet(), now) : "";
  }

  static Answer refusal(const Error& error) { return {false, error.message + "\n"}; }
  static Answer answer_to(const Result<void>& outcome) {
    return outcome ? Answer{true, "done\n"} : refusal(outcome.error());
  }

  void send(const mission::Message& message, Instant now) {
    recorder_.write(message, kGroundStation, now);
    // What a process that starts anew must know of is in the file before anybody acts on it.
    if (must_outlast(message)) recorder_.flush();
    network_.publish(message);
    console_.on_message(message, kGroundStation, now);
  }

  void hand_out(Instant now) {
    // First: what is decided is in the record, too, before it is said.
    while (const auto event = node_.poll_event()) {
      tell_of(*event, now);
    }
    while (const auto message = node_.poll_message()) {
      send(*message, now);
      if (const auto* change = std::get_if<formation::Change>(&*message)) {
        recorder_.write_places(*change);
      }
    }
    console_.on_traffic(node_.traffic().all());
    console_.on_decisions(node_.agent(), now);
    console_.on_timeout(
        node_.fleet(),
        {audit_.json(), areas_.json(now), commanding_.desk().json(now),
         commanding_.desk().nobody_commands(now), agencies_.receiver_trouble(), areas_.ended()},
        now);
    if (commanding_.is_commanding()) {
      agencies_.on_timeout(console_.picture(), node_.fleet(), now);
      ask_operator(now);
    }
    if (now >= next_flush_) {
      next_flush_ = now + kFlushPeriod;
      recorder_.flush();
    }
  }

  void ask_operator(Instant now) {
    for (const auto& pending : node_.agent().authorisations()) {
      if (pending.decision || is_scripted(pending.request.site)) continue;
      if (!shown_.emplace(pending.request.site, pending.request.round).second) continue;
      print(request_text(pending,
                         console::card_of(pending.request, console_.picture(), node_.fleet(), now),
                         origin_, clock_.epoch_unix_ns(), now));
    }
  }

  /// To machines that watch.
  void report(Instant now) {
    if (now < next_report_) return;
    next_report_ = now + kReportPeriod;
    console_.on_receptions(network_.ear().receptions());
    const auto traffic = process::traffic_of(network_.ear());
    HealthFacts facts;
    facts.version = version();
    facts.now = now;
    facts.sent = traffic.sent;
    facts.received = traffic.received;
    facts.dropped = traffic.dropped + node_.dropped();
    facts.of_strangers = traffic.of_strangers;
    facts.unproven = traffic.unproven;
    facts.restarts = traffic.restarts;
    facts.refused = node_.refused();
    facts.authorisations_waiting = static_cast<std::size_t>(
        std::ranges::count_if(node_.agent().authorisations(),
                              [](const auto& pending) { return !pending.decision.has_value(); }));
    facts.recordings = recorder_.running();
    facts.shall_record = !recording_folder_.empty();
    if (facts.shall_record) facts.disk_free_bytes = process::free_bytes(recording_folder_);
    facts.clock = process::clock_state();
    facts.among_machines = among_machines_;
    console_.report(machine_report(facts, node_.fleet()));
  }

  void tell_of(const mission::MissionEvent& event, Instant now) {
    process::log_event(event);
    recorder_.write(event);
    console_.on_event(event, now);
    agencies_.on_event(event);
  }

  [[nodiscard]] bool is_scripted(SiteId site) const {
    return std::any_of(decisions_.begin(), decisions_.end(),
                       [&](const auto& decision) { return decision.site == site; });
  }

  MissionOrigin origin_;
  std::string operator_name_;       ///< who decides at the prompt and the command line
  const std::string own_operator_;  ///< that, where no key is unlocked
  const process::MissionClock& clock_;
  const process::Shutdown& shutdown_;
  StationNetwork& network_;
  Commanding commanding_;
  process::Wake& wake_;
  Recorder recorder_;
  std::vector<configuration::OperatorDecision>
      decisions_;  ///< of the scenario, in the operator's place
  OperatorKeys& keys_;
  Revocations& revocations_;
  mission::GroundNode& node_;
  FormationDesk formation_;
  SiteDesk sites_;
  RouteDesk routes_;
  FenceDesk fence_;
  ReturnDesk returns_;
  AreaDesk areas_;
  std::unique_ptr<ControlSocket> control_;
  ConsoleDesk console_;
  AgencyDesk agencies_;
  Audit audit_;
  std::set<std::pair<SiteId, coalition::Round>> shown_;
  Instant next_for_watchers_ = Instant::min();
  Instant next_flush_{Instant::min()};
  std::string recording_folder_;
  bool among_machines_;
  Instant next_report_{Instant::min()};
  std::atomic<std::uint64_t> steps_{0};
  std::atomic<bool> speak_{false};
  std::atomic<bool> stopping_{false};
};

}  // namespace

std::string control_socket_of(const configuration::GroundConfig& config) {
  return config.control_socket.empty() ? control_socket_name(config.network.port)
                                       : config.control_socket;
}

namespace {

/// Until the process is asked to end; the service manager's watchdog is fed while the loop gets on.
const char* wait_watched(const GroundLoop& loop, const process::Shutdown& shutdown,
                         const process::Service& service) {
  service.ready();
  process::ProgressWatch progress{1, std::chrono::steady_clock::now()};
  while (true) {
    const auto period = service.watchdog_period().value_or(kLookAgain);
    if (const char* signal = shutdown.wait_for(period)) return signal;
    const auto now = std::chrono::steady_clock::now();
    if (progress.all_moved(std::array{loop.steps()}, now)) service.feed_watchdog();
  }
}

int fail(const char* what, const Error& why, int exit_code) {
  spdlog::critical("{}: {}", what, why.message);
  return exit_code;
}

}  // namespace

int run(const configuration::GroundConfig& config, const Login& login) {
  const process::Shutdown shutdown;
  const process::MissionClock clock{config.time.epoch_unix_ns, config.time.rate};
  process::start_log(clock);
  process::CloseLimit close_limit;
  const auto origin = MissionOrigin::make(config.origin);
  if (!origin)
    return fail("the mission origin is unusable", origin.error(), process::kExitBadInput);
  const std::uint16_t station = config.command.station;
  auto start =
      process::start_node(config.network, station == 0 ? kGroundStation : station_node(station));
  if (!start)
    return fail("cannot join the mission network", start.error(), process::kExitCannotStart);
  const InstanceId instance = start->instance;
  const std::filesystem::path folder = config.network.keys;
  OperatorKeys keys = start->identity ? OperatorKeys{folder, start->identity->verifier(),
                                                     &identity_desk::now_unix_s}
                                      : OperatorKeys{};
  Revocations revocations = start->identity ? Revocations{folder} : Revocations{};
  if (const auto unlocked = unlock_first(keys, config.op, login); !unlocked)
    return fail("no operator's key", unlocked.error(), process::kExitBadInput);
  mission::GroundNode ground{node_config(config, instance, keys), clock.now()};
  auto formation = FormationDesk::open(config.formation, config.vehicles, ground);
  if (!formation)
    return fail("the formation's orders are unusable", formation.error(), process::kExitBadInput);
  ConsoleDesk console{config, *origin};
  recall_mission(config, clock.epoch_unix_ns(), ground, console);
  auto recorder = open_recorder(config, instance, clock.epoch_unix_ns());
  if (!recorder) return fail("cannot record", recorder.error(), process::kExitCannotStart);
  process::Wake wake;
  auto opened = StationNetwork::open(config.network, *start, wake);
  if (!opened)
    return fail("cannot join the mission network", opened.error(), process::kExitCannotStart);
  StationNetwork& network = **opened;

  serve_console(console, config, clock.epoch_unix_ns(), keys, wake);
  auto audit = Audit::open(config.recording_folder, audit_key(*start));
  if (!audit) return fail("cannot record", audit.error(), process::kExitCannotStart);

  log_start(config, *start, login.name);
  process::log_unused_keys(config.network, config.recording_folder);
  GroundLoop loop{config,
                  *origin,
                  login.name,
                  clock,
                  shutdown,
                  network,
                  instance,
                  wake,
                  std::move(*recorder),
                  keys,
                  revocations,
                  ground,
                  std::move(*formation),
                  open_control(config, wake),
                  std::move(console),
                  std::move(*audit)};
  const auto key_watch = watch_keys(*start, config.network, network,
                                    [&loop](const auto& revoked) { loop.on_revoked(revoked); });
  std::thread thread{[&loop] { loop.run(); }};
  const process::Service service;
  const char* signal = wait_watched(loop, shutdown, service);
  service.stopping();
  spdlog::info("{}: stopping", signal);
  loop.stop();
  thread.join();
  log_summary(network.ear(), ground);
  close_limit.start(process::kCloseWithin);
  return 0;
}

}  // namespace skein::groundstation
