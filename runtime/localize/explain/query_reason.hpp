// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>
#include <string>

#include "runtime/localize/camera/camera_model.hpp"
#include "runtime/localize/query/query_result.hpp"

namespace zonepack::localize {

inline constexpr double kDegreeInRad = std::numbers::pi / 180;

// What was asked for, for the words of query_reason().
struct QueryAsked {
  CameraModel camera;
  int image_width = 0, image_height = 0;
  int needed = 8, needed_cells = 4;
  bool with_prior = false;
  std::string nearest_zone;  // by name
};

// Why there is a pose or none, in one sentence, with the figures that decided: "12 of 15 matches
// needed; the nearest signature (412 in L1, 0.8 m away) looks 94 degrees to the side".
std::string query_reason(const QueryResult& result, const QueryAsked& asked);

}  // namespace zonepack::localize
