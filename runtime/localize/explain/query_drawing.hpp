// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "runtime/localize/camera/grey_image.hpp"
#include "runtime/localize/query/map_features.hpp"
#include "runtime/localize/query/query_result.hpp"
#include "runtime/map/catalog.hpp"
#include "runtime/report/report.hpp"

namespace zonepack::localize {

// The image with its matches: inliers, where the pose puts their points, and those that disagree.
report::Svg draw_matches(const GreyImage& image, const QueryResult& result);

// The map around the pose: signatures, the points that were matched, the robot and what it sees.
// `guess` is where the robot was said to be, if it was.
report::Svg draw_place(const Catalog& catalog, const std::vector<MapFeatures>& map,
                       const QueryResult& result, const std::optional<Pose2>& guess);

}  // namespace zonepack::localize
