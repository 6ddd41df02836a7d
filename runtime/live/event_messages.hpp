// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/run/run.hpp"

namespace zonepack {

// Prints, on standard error, a line for each event that people should do something about, and says
// what to do.
//
// Threads: the log thread.
class EventMessages final : public RunObserver {
 public:
  void on_event(const Event& event, const MapVersion& map) noexcept override;
};

}  // namespace zonepack
