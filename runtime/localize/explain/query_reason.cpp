// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/explain/query_reason.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>

#include "platform/base/counted.hpp"
#include "runtime/localize/camera/grey_image.hpp"

namespace zonepack::localize {
namespace {

std::string rounded(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

// The signature that is nearest to where the robot was said to be.
std::string nearest_text(const QueryResult& result, const QueryAsked& asked) {
  if (!asked.with_prior || result.nearest == 0) return "";
  return "; the nearest signature (" + std::to_string(result.nearest) +
         (asked.nearest_zone.empty() ? "" : " in " + asked.nearest_zone) + ", " +
         rounded(result.nearest_m, 1) + " m away) looks " +
         rounded(result.nearest_turn_rad / kDegreeInRad, 0) + " degrees to the side";
}

std::string features_text(int count) {
  return counted(static_cast<std::uint64_t>(count), "feature");
}

// What of the rest of the map in view was recognised, where it was looked for.
std::string second_look_text(const QueryResult& result) {
  if (result.looked_at == 0) return "";
  return "; of " + counted(static_cast<std::uint64_t>(result.looked_at), "place") +
         " more where the map has a point, " + std::to_string(result.recognised) + " look like it";
}

}  // namespace

std::string query_reason(const QueryResult& result, const QueryAsked& asked) {
  const std::string needed = std::to_string(asked.needed);
  const std::string inliers = std::to_string(result.distinct);
  switch (result.reason) {
    case Reason::kAccepted:
      return inliers + " matches agree (" + needed + " needed), in " +
             std::to_string(result.cells) + " of 16 parts of the image";
    case Reason::kWrongSize:
      return "the image has " + size_text(asked.image_width, asked.image_height) +
             " pixels, the calibration is of " + size_text(asked.camera.width, asked.camera.height);
    case Reason::kNoFeatures:
      return "the image shows " + features_text(result.features) + ", and a pose needs " + needed +
             ": it is dark, overexposed, blurred or covered";
    case Reason::kNoSignature:
      return asked.with_prior
                 ? "no signature with features is within 12 m; the robot is elsewhere, or the map "
                   "ends here"
                 : "no signature has features whose place is known";
    case Reason::kNotInView:
      return "no signature saw what the camera should see" + nearest_text(result, asked);
    case Reason::kFewMatches:
      return std::to_string(result.matches) + " of " + needed + " matches needed" +
             nearest_text(result, asked);
    case Reason::kFewInliers:
      return inliers + " of " + needed + " matches needed agree on a pose, of " +
             std::to_string(result.matches) + nearest_text(result, asked);
    case Reason::kChance:
      return inliers + " matches agree, but no more and no more alike than chance gives where " +
             std::to_string(result.visible) +
             " features have a point of the map nearby (evidence " + rounded(result.evidence, 1) +
             " of " + rounded(kLeastEvidence, 1) + " needed" + second_look_text(result) + ")" +
             nearest_text(result, asked);
    case Reason::kGathered:
      return inliers + " matches agree, but in " + std::to_string(result.cells) + " of " +
             std::to_string(asked.needed_cells) + " parts of the image needed" +
             nearest_text(result, asked);
    case Reason::kFarFromPrior:
      return inliers + " matches agree on " + rounded(result.pose.x_m, 2) + "," +
             rounded(result.pose.y_m, 2) + "," + rounded(result.pose.yaw_rad / kDegreeInRad, 1) +
             ", which is too far from where the robot was said to be";
    case Reason::kNotLevel:
      return inliers + " matches agree on a pose " +
             rounded(result.T_map_base.translation().z() * 100, 0) +
             " cm high or tilted by more than 6 degrees: check the calibration's local_transform";
    case Reason::kUnsure:
      return inliers + " matches agree, but leave the position open by " +
             rounded(100 * std::sqrt(std::max(result.covariance.xx, result.covariance.yy)), 0) +
             " cm (one standard deviation)";
    case Reason::kRival:
      return inliers + " matches agree, but nearly as many on another pose";
  }
  return "";
}

}  // namespace zonepack::localize
