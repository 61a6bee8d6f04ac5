// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/recorder.hpp"

#include <spdlog/spdlog.h>

#include <chrono>
#include <type_traits>
#include <utility>

#include "skein/onboard/threads.hpp"

namespace skein::onboard {

Recorder::Recorder(std::optional<recording::Writer> writer, ControlPorts& control,
                   EventRing& events, AgentRing& agent, LoadBook loads)
    : writer_{std::move(writer)},
      control_{&control},
      events_{&events},
      agent_{&agent},
      loads_{std::move(loads)} {}

void Recorder::run() {
  const auto period = spec_of(ThreadRole::recorder).period;
  auto next_flush = std::chrono::steady_clock::now();
  while (!stopping_) {
    const auto now = std::chrono::steady_clock::now();
    empty_rings();
    if (now >= next_flush) {
      next_flush = now + std::chrono::seconds{1};
      flush();
    }
    wake_.wait_until(now + period);
  }
  empty_rings();
  flush();
}

void Recorder::stop() {
  stopping_ = true;
  wake_.notify();
}

void Recorder::empty_rings() {
  const auto empty = [this](auto& ring) {
    while (const auto item = ring.pop()) {
      if constexpr (std::is_same_v<decltype(*item), const mission::MissionEvent&>) {
        note_load(*item);
      }
      if (writer_) writer_->write(*item);
    }
  };
  empty(control_->track);
  empty(control_->plans);
  empty(*events_);
  empty(*agent_);
  const std::uint64_t lost = control_->track.dropped() + control_->plans.dropped() +
                             events_->dropped() + agent_->dropped();
  if (writer_ && lost > lost_) writer_->write(recording::Gap{lost - lost_});
  lost_ = lost;
}

void Recorder::note_load(const mission::MissionEvent& event) {
  if (event.kind() != mission::EventKind::task_started || event.task.kind != TaskKind::deliver) {
    return;
  }
  if (const auto noted = loads_.use(); !noted) {
    spdlog::error("a program that starts anew will not know of the load that is used now: {}",
                  noted.error().message);
  }
}

void Recorder::flush() {
  if (!writer_) return;
  const auto flushed = writer_->flush();
  if (flushed) return;
  spdlog::error("recording stops: {}", flushed.error().message);
  writer_.reset();
}

}  // namespace skein::onboard
