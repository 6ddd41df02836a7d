// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "runtime/localize/features/image_features.hpp"
#include "runtime/localize/query/query_result.hpp"
#include "runtime/odometry/pose.hpp"
#include "runtime/pack_format/ids.hpp"

namespace zonepack::localize {

// What a lost robot saw at one moment, and where it was then by its wheels alone.
struct LostView {
  std::uint64_t number = 0;  // of the image, rising
  std::int64_t stamp_ns = 0;
  Pose2 T_wheels_base;  // in a frame that drifts and starts anywhere
  ImageFeatures features;
};

// Where a view may have been taken, by the signatures of one zone.
struct Sight {
  Pose2 pose;  // base_link in the map
  Covariance2 covariance;
  int distinct = 0;       // inliers
  int visible = 0;        // features of the image with a projected point of the map within 8 px
  int expected = 0;       // of them, those that should agree: QueryResult::expected
  bool accepted = false;  // would be a fix if this were the robot's known place
};

// An image speaks against a place when this many of its features should agree with the map there,
// and fewer do than this part of them.
inline constexpr int kShouldSee = 60;
inline constexpr double kLeastExplained = .12;
inline bool speaks_against(int distinct, int expected, int should_see = kShouldSee,
                           double least_explained = kLeastExplained) noexcept {
  return expected >= should_see && distinct < least_explained * expected;
}

inline Sight sight_of(const QueryResult& result) {
  return {result.pose,    result.covariance, result.distinct,
          result.visible, result.expected,   result.accepted};
}

}  // namespace zonepack::localize
