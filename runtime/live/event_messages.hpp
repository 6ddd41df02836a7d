// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/control/event.hpp"
#include "runtime/run/map_version.hpp"

namespace zonepack {

// Tells people, on standard error, of events that they should do something about: a line each, with
// what to do. Passes all events on.   Threads: one; not for a control thread.
class EventMessages final : public EventSink {
 public:
  // Both must outlive this object.
  EventMessages(const MapFollower& maps, EventSink& next) : maps_(maps), next_(next) {}

  void on_event(const Event& event) noexcept override;

 private:
  const MapFollower& maps_;
  EventSink& next_;
};

}  // namespace zonepack
