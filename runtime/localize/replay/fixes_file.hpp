// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "platform/base/failure.hpp"
#include "runtime/localize/replay/camera_loop.hpp"
#include "runtime/map/catalog.hpp"
#include "runtime/run/inputs/command_lines.hpp"

namespace zonepack::localize {

// The fixes of a loop as read_corrections() reads them, on the clock of the log as it stands.
// Numbers read back exactly: `zoned replay --corrections` decides the same.
// Commands to zoned come as lines that begin with "# command" (command_lines.hpp), with
// zones by the names of the catalog.
std::string fixes_text(std::span<const LoopView> views, std::span<const TimedCommand> commands = {},
                       const Catalog* map = nullptr);

Outcome<void> write_fixes(const std::string& path, std::span<const LoopView> views,
                          std::span<const TimedCommand> commands = {},
                          const Catalog* map = nullptr);

}  // namespace zonepack::localize
