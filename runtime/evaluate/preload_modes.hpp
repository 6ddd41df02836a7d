// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "runtime/control/cycle.hpp"

namespace zonepack {

// A way to load zones ahead of the robot, for comparison.
struct PreloadMode {
  std::string_view name;
  void (*choose)(CycleConfig& config);  // changes what the settings say
  bool foresees;                        // false: there is nothing to judge
  bool takes_route;                     // hints of a route are passed on
  bool by_habits = false;               // what was learned is used, and learned on
  bool knows_route = false;  // the zones that a log's drive enters are hinted from its start on
};

// All that `zoned evaluate --preload` knows: `none`, only zones that the robot may be in; `portal`,
// by the robot's motion; `transitions`, also by what was learned; `route`, also by the drive's
// whole route, as from a robot that knows its mission.
const std::vector<PreloadMode>& preload_modes();

// Null: no such mode.
const PreloadMode* find_preload(std::string_view name);

}  // namespace zonepack
