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
};

// All that `zoned evaluate --preload` knows: `none`, only zones that the robot may be in; `portal`,
// as zoned does by its settings.
const std::vector<PreloadMode>& preload_modes();

// Null: no such mode.
const PreloadMode* find_preload(std::string_view name);

}  // namespace zonepack
