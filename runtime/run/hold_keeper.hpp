// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "runtime/run/figures/run_trace.hpp"

namespace zonepack {

// Pairs what events say about zones into the times during which each took memory. Times are seconds
// since the start of the run.
//
// Threads: one.
// Memory: at most `most` holds that have ended, and one a zone that has not. When they are that
// many, the shorter half is dropped: what a drawing of a long run would not show.
class HoldKeeper {
 public:
  static constexpr std::size_t kMost = 20'000;
  explicit HoldKeeper(std::size_t most = kMost) : most_(most) {}

  void begin(ZoneId zone, double t_s);
  void ready(ZoneId zone, double t_s);
  void end(ZoneId zone, double t_s);
  void end_all(double t_s);

  // All holds by their beginning; those that go on end here. Empties the keeper.
  std::vector<TraceHold> take(double t_s);

 private:
  struct Open {
    double from_s = 0;
    double ready_s = -1;  // before 0: not yet
  };
  void keep(ZoneId zone, const Open& open, double t_s);

  std::size_t most_;
  std::map<ZoneId, Open> open_;
  std::vector<TraceHold> ended_;
};

}  // namespace zonepack
