// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "platform/can_log.hpp"

namespace zonepack {

// Tells what was wrong with a CAN log, on standard error.
void tell_log_faults(const std::string& path, const CanLogSummary& summary);

}  // namespace zonepack
