// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "platform/base/failure.hpp"
#include "runtime/control/command.hpp"

// Commands of a localizer to zoned, in the file of its fixes. A line is
//
//   # command RECEIVED WORD [ZONE]
//
// RECEIVED: seconds, as of a fix. WORD: lost; seek, with a zone's name, or without one when no zone
// is sought any more; ask_turn. A program that plans missions may add route_hint, with the zones of
// a way in their order, apart by /, or without one when it ends. A reader that knows only fixes
// passes over it.
namespace zonepack {

struct TimedCommand {
  std::int64_t received_ns = 0;
  Command command;
};

std::string command_line(std::int64_t received_ns, const Command& command, std::string_view zone);

// In order of reception. Other lines are passed over. find_zone gives kNoZone for a name that the
// map does not have. Failures name file:line.
Outcome<std::vector<TimedCommand>> read_command_lines(
    const std::string& path, const std::function<ZoneId(std::string_view)>& find_zone);

}  // namespace zonepack
