// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/replay_process.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <thread>
#include <variant>

#include "skein/codec/json_text.hpp"
#include "skein/console/sections.hpp"
#include "skein/console/team_fence.hpp"
#include "skein/console/team_preflight.hpp"
#include "skein/groundstation/console_desk.hpp"
#include "skein/groundstation/control_socket.hpp"
#include "skein/groundstation/line_reader.hpp"
#include "skein/groundstation/playback.hpp"
#include "skein/groundstation/prompt.hpp"
#include "skein/groundstation/vehicle_text.hpp"
#include "skein/groundstation/views.hpp"
#include "skein/process/log.hpp"
#include "skein/process/shutdown.hpp"
#include "skein/process/wake.hpp"

namespace skein::groundstation {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr auto kPeriod = std::chrono::milliseconds{50};
constexpr double kSpeedMin = 0.1;
constexpr double kSpeedMax = 100.0;
constexpr const char* kOrders = "a recording takes: play, pause, speed 0.1 to 100, seek SECONDS";

/// NaN where it is no number.
double number(std::string_view word) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool whole = error == std::errc{} && end == word.data() + word.size();
  return whole ? value : std::nan("");
}

/// Moves a recording by the clock and by orders, and shows it.
class ReplayLoop {
 public:
  ReplayLoop(Playback playback, double speed, const process::Shutdown& shutdown)
      : playback_{std::move(playback)}, speed_{speed}, shutdown_{shutdown} {}

  Result<void> serve(console::ServerConfig config, const std::string& name) {
    config.hello = hello_text(playback_.origin(), playback_.picture().params().expected, {}, {}, {},
                              {}, ShownRecording{name, playback_.begin(), playback_.end()});
    auto opened = console::Server::open(std::move(config), [this] { wake_.notify(); });
    if (!opened) return opened.error();
    server_ = std::move(*opened);
    return {};
  }
  /// Before it is served.
  void wait_at(Instant moment) {
    playback_.go_to(moment);
    playing_ = false;
  }
  [[nodiscard]] std::string url() const { return server_->url(); }

  void run() {
    LineReader prompt{STDIN_FILENO, [this] { wake_.notify(); }};
    auto last = SteadyClock::now();
    append_events();
    while (!stopping_) {
      const auto now = SteadyClock::now();
      if (playing_) {
        move_to(playback_.now() +
                from_seconds(std::chrono::duration<double>(now - last).count() * speed_));
      }
      last = now;
      while (const auto line = prompt.next()) {
        if (const auto input = parse_input(*line); input && std::holds_alternative<Quit>(*input)) {
          shutdown_.request();
          continue;
        }
        const Answer given = answer(*line);
        std::fputs(given.text.c_str(), given.done ? stdout : stderr);
        std::fflush(stdout);
      }
      take_requests();
      show();
      wake_.wait_until(now + kPeriod);
    }
  }
  /// From another thread.
  void stop() {
    stopping_ = true;
    wake_.notify();
  }

 private:
  void take_requests() {
    while (auto request = server_->next()) {
      if (auto* line = std::get_if<console::Server::Line>(&*request)) {
        const Answer given = line->order.empty() ? answer(line->line)
                                                 : Answer{false, "a recording takes no orders\n"};
        line->reply(given.done, given.text, given.data);
      } else {
        std::get<console::Server::Join>(*request).reply(console::series_of(playback_.picture()));
        shown_again_ = true;
      }
    }
  }

  Answer answer(const std::string& line) {
    if (const auto order = parse_replay_order(line)) {
      obey(*order);
      return {true, fmt::format("at {:.1f} s, {} at speed {:g}\n", to_seconds(playback_.now()),
                                playing_ ? "playing" : "paused", speed_)};
    }
    if (const auto input = parse_input(line)) {
      if (const auto* view = std::get_if<View>(&*input)) return look(*view);
      if (const auto* of = std::get_if<PreflightOf>(&*input)) {
        return preflight_answer(playback_.fleet(), of->vehicle, playback_.now());
      }
      if (const auto* of = std::get_if<StatusOf>(&*input)) {
        return vehicle_answer(of->vehicle, playback_.picture(), playback_.fleet(), "",
                              playback_.now());
      }
      if (std::holds_alternative<std::monostate>(*input)) return {true, ""};
    }
    return {false,
            fmt::format("{}; status, sites, coalitions and the other views look; quit ends\n",
                        kOrders)};
  }

  [[nodiscard]] Answer look(View view) const {
    const auto section = section_of(view);
    if (!section) return {true, fmt::format("{}\n", kOrders)};
    std::string data =
        view == View::alarms
            ? console::alarms_json(playback_.alarms())
            : console::section_of(*section, playback_.picture(), playback_.fleet(),
                                  playback_.origin(), playback_.version(), playback_.now());
    std::string text = text_of(view);
    return {true, text.empty() ? data + "\n" : std::move(text), std::move(data)};
  }

  /// None where a recording has only data.
  [[nodiscard]] std::string text_of(View view) const {
    switch (view) {
      case View::status:
        return fleet_table(playback_.fleet().vehicles(), playback_.now());
      case View::sites:
        return sites_text(playback_.picture());
      case View::coalitions:
        return coalitions_text(playback_.picture());
      case View::hazards:
        return hazards_text(playback_.picture());
      case View::fence:
        return console::fence_text(playback_.picture(), playback_.fleet());
      case View::alarms:
        return console::alarms_text(playback_.alarms(), playback_.now());
      case View::preflight:
        return console::preflight_text(console::team_preflight(playback_.fleet(), playback_.now()),
                                       playback_.now());
      default:
        return picture_text(view, playback_.picture(), playback_.fleet(), playback_.now());
    }
  }

  void obey(const ReplayOrder& order) {
    switch (order.kind) {
      case ReplayOrder::Kind::play:
        if (playback_.now() >= playback_.end()) jump_to(playback_.begin());
        playing_ = true;
        break;
      case ReplayOrder::Kind::pause:
        playing_ = false;
        break;
      case ReplayOrder::Kind::speed:
        speed_ = order.value;
        break;
      case ReplayOrder::Kind::seek:
        jump_to(at_seconds(order.value));
        break;
    }
    shown_again_ = true;
  }

  /// On the way: what was passed is shown.
  void move_to(Instant time) {
    playback_.go_to(time);
    if (playback_.now() >= playback_.end()) playing_ = false;
    append_events();
    shown_again_ = true;
  }

  void jump_to(Instant time) {
    playback_.go_to(time);
    append_events();
    appended_ = playback_.events_so_far();
    server_->restart(appended_, console::series_of(playback_.picture()));
  }

  void append_events() {
    const std::size_t so_far = playback_.events_so_far();
    if (so_far <= appended_) return;
    std::vector<std::string> passed;
    for (; appended_ < so_far; ++appended_) passed.push_back(playback_.events()[appended_].json);
    server_->append(std::move(passed));
  }

  void show() {
    if (!shown_again_ || !server_->watched()) return;
    shown_again_ = false;
    auto sections = console::sections_of(playback_.picture(), playback_.fleet(), playback_.origin(),
                                         playback_.version(), playback_.now());
    sections[static_cast<std::size_t>(console::Section::audit)] = "[]";
    sections[static_cast<std::size_t>(console::Section::alarms)] =
        console::alarms_json(playback_.alarms());
    sections[static_cast<std::size_t>(console::Section::replay)] = codec::json_text(
        {{"time_s", to_seconds(playback_.now())}, {"playing", playing_}, {"speed", speed_}});
    server_->publish(to_seconds(playback_.now()), std::move(sections));
  }

  Playback playback_;
  double speed_;
  const process::Shutdown& shutdown_;
  bool playing_ = true;
  bool shown_again_ = true;   ///< something has changed since it was shown
  std::size_t appended_ = 0;  ///< events that the server has
  process::Wake wake_;
  std::unique_ptr<console::Server> server_;
  std::atomic<bool> stopping_{false};
};

}  // namespace

Result<ReplayOrder> parse_replay_order(const std::string& line) {
  const auto first = line.find_first_not_of(" \t");
  const auto last = line.find_last_not_of(" \t\r\n");
  const std::string_view all = first == std::string::npos
                                   ? std::string_view{}
                                   : std::string_view{line}.substr(first, last - first + 1);
  const auto space = all.find(' ');
  const std::string_view verb = all.substr(0, space);
  const double value =
      space == std::string_view::npos ? std::nan("") : number(all.substr(space + 1));
  using Kind = ReplayOrder::Kind;
  if (all == "play") return ReplayOrder{Kind::play};
  if (all == "pause") return ReplayOrder{Kind::pause};
  if (verb == "speed" && value >= kSpeedMin && value <= kSpeedMax) {
    return ReplayOrder{Kind::speed, value};
  }
  if (verb == "seek" && std::abs(value) < 1e9) return ReplayOrder{Kind::seek, value};
  return Error{kOrders};
}

int replay(const std::filesystem::path& path, const configuration::ConsoleConfig& console,
           double speed, std::optional<Instant> at) {
  const process::Shutdown shutdown;
  const bool shows = ::isatty(STDERR_FILENO) == 1;
  auto playback = Playback::open(path, [shows](double share) {
    if (shows) std::fprintf(stderr, "\rreading %s %3.0f %%", "the recording", 100.0 * share);
  });
  if (shows) std::fputs("\r\033[K", stderr);
  if (!playback) {
    std::fprintf(stderr, "skein-ground: %s\n", playback.error().message.c_str());
    return process::kExitBadInput;
  }
  std::printf("%s: %.1f s to %.1f s, %zu events%s\n", path.c_str(), to_seconds(playback->begin()),
              to_seconds(playback->end()), playback->events().size(),
              playback->damaged() == 0
                  ? ""
                  : fmt::format("; {} damaged parts left out", playback->damaged()).c_str());
  ReplayLoop loop{std::move(*playback), speed, shutdown};
  if (at) loop.wait_at(*at);
  if (const auto served = loop.serve(server_config(console), path.filename().string()); !served) {
    std::fprintf(stderr, "skein-ground: %s\n", served.error().message.c_str());
    return process::kExitCannotStart;
  }
  std::printf("console: %s\n%s\n", loop.url().c_str(), kOrders);
  std::fflush(stdout);
  std::thread thread{[&loop] { loop.run(); }};
  shutdown.wait();
  loop.stop();
  thread.join();
  return 0;
}

}  // namespace skein::groundstation
