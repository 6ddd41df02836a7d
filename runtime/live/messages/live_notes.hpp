// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <variant>

#include "platform/memory/spsc_queue.hpp"
#include "runtime/control/event.hpp"
#include "runtime/run/figures/live_status.hpp"
#include "runtime/run/run_statistics.hpp"

namespace zonepack {

// What the control thread passes to the log thread: events, then what the cycle did.
struct LiveNote {
  enum class Kind : std::uint8_t { kEvent, kCycle };
  Kind kind = Kind::kEvent;
  Event event;
  CycleRecord cycle;
};

// Passes the events of the control thread to those who write and serve them.
//
// Real-time: one copy each; a full queue loses the event, and counts it.
// Threads: the control thread.
class EventFanOut final : public EventSink {
 public:
  EventFanOut(SpscQueue<LiveNote>& notes, SpscQueue<Event>* service, OverloadCounters& overload)
      : notes_(notes), service_(service), overload_(overload) {}

  void on_event(const Event& event) noexcept override {
    note_.kind = LiveNote::Kind::kEvent;
    note_.event = event;
    overload_.lost_events += !notes_.push(note_);
    if (service_ != nullptr) overload_.lost_service_events += !service_->push(event);
  }

  void after_cycle(const CycleRecord& cycle) noexcept {
    note_.kind = LiveNote::Kind::kCycle;
    note_.cycle = cycle;
    overload_.lost_records += !notes_.push(note_);
  }

 private:
  SpscQueue<LiveNote>& notes_;
  SpscQueue<Event>* service_;
  OverloadCounters& overload_;
  LiveNote note_;
};

}  // namespace zonepack
