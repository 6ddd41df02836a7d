// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/localize/replay/loop_command.hpp"

namespace zonepack::localize {

// `zoneloc check`: drives the recorded run as `zoneloc replay` does and looks for what the
// camera's calibration says wrongly. What is found is put right and the run driven again, until
// nothing is left to be found: with a wrong calibration some points are taken for outliers, and
// what is wrong looks smaller than it is. Returns the exit code: 0 also when something is wrong
// with the calibration; 1 when inputs cannot be read or give too few fixes to say.
int run_check(const LoopArguments& arguments);

}  // namespace zonepack::localize
