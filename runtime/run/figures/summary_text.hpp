// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "platform/base/failure.hpp"
#include "runtime/run/figures/run_summary.hpp"

namespace zonepack {

// The summary as one JSON object, with the keys of RunSummary in their order; pose_error_m and
// wrong_zone_s are null without truth, start_s and zone_absent_s when the robot was never
// localised. Numbers print so that they read back exactly.
std::string summary_json(const RunSummary& summary);

// The summary as a table for people.
std::string summary_table(const RunSummary& summary);

// Prints the table, and writes the JSON to a file; "-" prints the JSON instead; "" writes none.
// output_is_taken: standard output holds something else, and the table goes to standard error.
Outcome<void> write_summary(const RunSummary& summary, const std::string& json_path,
                            bool output_is_taken);

// Fails when the run exceeded a limit.
Outcome<void> check_limits(const RunSummary& summary);

}  // namespace zonepack
