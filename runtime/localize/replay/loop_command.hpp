// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "platform/base/failure.hpp"
#include "runtime/localize/check/calibration_watch.hpp"
#include "runtime/run/inputs/run_inputs.hpp"

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

// What a drive says about the camera.
struct LoopLessons {
  std::size_t images = 0;
  CalibrationWatch watch;
};

// Drives as run_loop() does, with a camera that is not quite as its calibration says, and writes
// nothing. `program` stands before messages.
Outcome<LoopLessons> drive_for_lessons(const LoopArguments& arguments, const char* program,
                                       const CameraTraits& camera_is_off_by);

// Drives the recorded run in simulated time with fixes from its images; the summary goes to
// standard output, messages and progress to standard error. Returns the exit code: 0, or 1 when
// something could not be read, held or written, or a limit was exceeded.
int run_loop(const LoopArguments& arguments);

}  // namespace zonepack::localize
