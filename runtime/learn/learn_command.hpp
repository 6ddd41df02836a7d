// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace zonepack {

// The command line of `zoned learn`; empty paths: not given.
struct LearnArguments {
  std::vector<std::string> drives;            // recordings and zone files, the oldest first
  std::string config;                         // for CAN logs
  std::vector<std::string> can, corrections;  // one for each, newer than the drives
  std::string map, from, out, json;
};

// Counts which zone comes after which, says how well each drive could have been foreseen by the
// others, and writes the file for preload.transitions. Returns the exit code: 0, or 1 when
// something could not be read or written or holds no step.
int run_learn(const LearnArguments& arguments);

}  // namespace zonepack
