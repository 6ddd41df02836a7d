// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "runtime/run/inputs/run_inputs.hpp"

namespace zonepack {

// The command line of `zoned replay`; empty paths: not given.
struct ReplayArguments : RunChoices {
  std::string can;
  std::string recording;             // instead of all other inputs
  std::string events, json, report;  // json "-": standard output
  std::string picture;               // the small picture
  std::string baseline;              // RTAB-Map's own curve, for both
};

// Reads what the arguments name, replays, and writes results; the summary goes to standard output,
// messages to standard error. Returns the exit code: 0, or 1 when something could not be read, held
// or written, or a limit was exceeded.
int run_replay(const ReplayArguments& arguments);

}  // namespace zonepack
