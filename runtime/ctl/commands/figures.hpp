// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "runtime/protocol/messages.hpp"

namespace zonepack {

// One number of the status, as `status --json` and `metrics` tell it.
struct Figure {
  enum class Kind { kCounter, kGauge, kFlag };
  const char* key;     // in JSON
  const char* metric;  // in Prometheus text
  Kind kind;
  const char* help;
  std::string value;  // "12", "0.0015"; flags "0" and "1"
};

// In the order in which they are shown.
std::vector<Figure> figures_of(const wire::Status& status);

// The status as one JSON object, and as Prometheus text (format 0.0.4).
// The version of the map in use, in hex.
std::string map_version(const wire::Status& status);
std::string status_json(const wire::Status& status);
std::string metrics_text(const wire::Status& status);

// The robot's GPIO lines, one each: "map_ready active, 3 changes".
std::vector<std::string> line_words(const wire::Status& status);

// What deserves attention, one line each, the worst first: "NOT KEEPING UP: ..." Empty when all is
// well.
std::vector<std::string> complaints(const wire::Status& status);

}  // namespace zonepack
