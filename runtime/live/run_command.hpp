// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "platform/base/failure.hpp"
#include "runtime/live/bus/can_source.hpp"
#include "runtime/run/inputs/run_inputs.hpp"

namespace zonepack {

// The command line of `zoned run`; empty paths: not given.
struct RunArguments : RunChoices {
  CanSourceChoice source;
  std::string events, json;  // json "-": standard output
  std::string record, record_can;
  std::optional<std::string> socket;  // over ZONED_SOCKET and the settings; empty: none
  std::string program;                // version, for recordings and those who ask
  std::string commit;
  bool allow_degraded = false;
  bool quiet = false;  // warnings and errors only
  bool check = false;  // see check_command.hpp
};

// Before the run: whether the files that it is to write could be written.
Outcome<void> check_run_outputs(const RunArguments& arguments);

// Drives the robot's threads until the source ends or SIGTERM or SIGINT comes. The summary goes to
// standard output, messages to standard error. Returns the exit code: 0, or 1 when something could
// not be read, held, granted or written, or a limit was exceeded; 2 for arguments that do not go
// together.
int run_live(const RunArguments& arguments);

}  // namespace zonepack
