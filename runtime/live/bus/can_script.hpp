// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "platform/sim/sim_wire.hpp"
#include "runtime/live/bus/generated_drive.hpp"

namespace zonepack {

// Traffic of other nodes, for the whole run.
struct ScriptTraffic {
  std::uint32_t id = 0;
  bool extended = false;
  double period_s = 0.01;
  std::uint32_t length = 8;
};

// A simulated bus, as platform/sim/SCRIPT.md describes the file.
struct CanScript {
  std::string log;      // candump log, as the file names it from its own folder; or
  DriveSettings drive;  // without a log
  std::uint32_t loops = 1;
  std::vector<ScriptTraffic> traffic;
  SimWireSettings wire;
  std::uint32_t queue = 0;  // frames; 0: without limit
};

struct LoadedCanScript {
  CanScript script;
  std::vector<std::string> faults;  // complete messages; empty: the script is good
};
LoadedCanScript load_can_script(const std::string& path);
LoadedCanScript parse_can_script(const std::string& text, const std::string& path);

}  // namespace zonepack
