// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "platform/can/can_log.hpp"

namespace zonepack {

// Says on standard error what was wrong with a CAN log, and where its clock was set.
void tell_log_faults(const std::string& path, const CanLogSummary& summary);

}  // namespace zonepack
