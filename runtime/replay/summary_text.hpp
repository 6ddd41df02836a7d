// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "runtime/replay/run_summary.hpp"

namespace zonepack {

// The summary as one JSON object, with the keys of RunSummary in their order; pose_error_m is null
// without truth. Numbers print so that they read back exactly.
std::string summary_json(const RunSummary& summary);

// The summary as a table for people.
std::string summary_table(const RunSummary& summary);

}  // namespace zonepack
