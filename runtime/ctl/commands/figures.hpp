// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "runtime/protocol/messages.hpp"

// A status in words for zonectl. The numbers are those of serve/status_figures.hpp.
namespace zonepack {

// The status as one JSON object.
std::string status_json(const wire::Status& status);

// The status as Prometheus text, format 0.0.4.
std::string metrics_text(const wire::Status& status);

// Every number of the status on a line of its own: "zones_resident         3".
std::vector<std::string> figure_lines(const wire::Status& status);

// The version of the map in use, in hex.
std::string map_version(const wire::Status& status);

// The robot's GPIO lines, one each: "map_ready active, 3 changes".
std::vector<std::string> line_words(const wire::Status& status);

// What needs attention, one line each, the worst first: "NOT KEEPING UP: ..." Empty when all is
// well.
std::vector<std::string> complaints(const wire::Status& status);

}  // namespace zonepack
