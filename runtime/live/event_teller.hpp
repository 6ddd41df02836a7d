// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/control/event.hpp"
#include "runtime/run/run_map.hpp"

namespace zonepack {

// Tells people, on standard error, of events that they should do something about: a line each, with
// what to do. Passes all events on.   Threads: one; not for a control thread.
class EventTeller final : public EventSink {
 public:
  // Both must outlive this object.
  EventTeller(const MapFollower& maps, EventSink& next) : maps_(maps), next_(next) {}

  void on_event(const Event& event) noexcept override;

 private:
  const MapFollower& maps_;
  EventSink& next_;
};

}  // namespace zonepack
