// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace zonepack {

// `zoned --safe-outputs`: after a crash the kernel leaves lines as they were, so somebody sets the
// outputs of the settings to their safe levels. Returns the exit code: 0, or 1 when the settings
// cannot be used or a line could not be set; the others are. Messages go to standard error.
int run_safe_outputs(const std::string& config);

}  // namespace zonepack
