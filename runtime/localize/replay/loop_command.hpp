// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "runtime/run/run_inputs.hpp"

namespace zonepack::localize {

// The command line of `zoneloc replay`; empty paths: not given.
struct LoopArguments : RunChoices {
  bool lost = false;  // --start lost: nothing is known of the pose
  std::string can;
  std::string images;       // a list, as TUM's rgb.txt
  std::string calibration;  // of the camera
  double latency_s = 0.15;  // from an image's stamp to its fix
  std::string fixes, events, json, report;
  std::string picture;   // the plan of the fixes alone
  std::string beside;    // another localizer's fixes, for report and picture
  std::string baseline;  // RTAB-Map's own run, for the report
};

// Drives the recorded run in simulated time with fixes from its images; the summary goes to
// standard output, messages and progress to standard error. Returns the exit code: 0, or 1 when
// something could not be read, held or written, or a limit was exceeded.
int run_loop(const LoopArguments& arguments);

}  // namespace zonepack::localize
