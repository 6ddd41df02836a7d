// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/live/run_command.hpp"

namespace zonepack {

// `zoned run --check`: tries everything that a run can be refused for, looks at the computer, and
// prints both as one table, with the exact line that mends each shortcoming; nothing is left
// running. Returns 0, or 1 when the run would be refused; shortcomings of the computer alone do not
// refuse it.
int check_run(const RunArguments& arguments);

}  // namespace zonepack
