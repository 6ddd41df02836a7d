// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "platform/base/failure.hpp"
#include "runtime/localize/replay/camera_loop.hpp"

namespace zonepack::localize {

// The fixes of a loop as read_corrections() reads them, on the clock of the log as it stands.
// Numbers read back exactly: `zoned replay --corrections` decides the same.
std::string fixes_text(std::span<const LoopView> views);

Outcome<void> write_fixes(const std::string& path, std::span<const LoopView> views);

}  // namespace zonepack::localize
