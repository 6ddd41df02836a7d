// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "runtime/odometry/pose.hpp"
#include "runtime/pack_format/ids.hpp"

namespace zonepack::localize {

// Where the robot is thought to be when the image is taken.
struct QueryPrior {
  Pose2 T_map_base;
  Covariance2 covariance;
};

// Why a query gave a pose or none.
enum class Reason : std::uint8_t {
  kAccepted,
  kWrongSize,     // the image is not of the calibration's size
  kNoFeatures,    // fewer features in the image than a fix needs: dark, blank or blurred
  kNoSignature,   // no signature with features in reach of the prior
  kNotInView,     // signatures are near, but none looked where the camera looks
  kFewMatches,    // too few features look alike
  kFewInliers,    // they do not agree on a pose
  kChance,        // no more agree, and no more alike, than chance would give
  kGathered,      // they agree, in one part of the image only
  kFarFromPrior,  // they agree on a pose that the prior excludes
  kNotLevel,      // they agree on a pose that is tilted or off the floor
  kUnsure,        // the pose's covariance is too wide to be of use
  kRival,         // another pose, of another place or nearby, explains the image about as well
};
inline constexpr std::size_t kReasons = 13;
// As in the JSON: "accepted", "wrong_size", "no_features" …
const char* to_string(Reason reason) noexcept;

// Thread-CPU times of the stages of a query.
enum class Stage : std::uint8_t { kDetect, kDescribe, kSelect, kMatch, kRansac, kRefine };
inline constexpr std::size_t kStages = 6;
const char* to_string(Stage stage) noexcept;

// A feature of the image and the map's feature that it was matched with.
struct DrawnMatch {
  float x_px = 0, y_px = 0;          // in the image, as seen
  float map_x_px = 0, map_y_px = 0;  // where the pose puts the map's point; as seen
  Eigen::Vector3f p_map = Eigen::Vector3f::Zero();
  SignatureId signature = 0;
  bool inlier = false;
};

// Of a pose that is accepted; QueryResult::evidence.
inline constexpr double kLeastEvidence = 4;

struct QueryResult {
  bool accepted = false;
  Reason reason = Reason::kNoFeatures;
  // The pose and its covariance; of a query that was not accepted, the best found, if any.
  bool found = false;
  Pose2 pose;
  Covariance2 covariance;
  Eigen::Isometry3d T_map_base = Eigen::Isometry3d::Identity();
  double floor_z_m = 0;  // where the map has the floor there
  int features = 0;      // of the image
  int places_found = 0;  // without the detector, when its features were not enough
  int matches = 0;       // of the pass that counts
  int inliers = 0;       // matches that the pose explains
  int distinct = 0;      // inliers of distinct features of the image at distinct pixels
  double sure = 0;       // the distinct ones, each by how alike its descriptors are, 0 to 1
  double evidence = 0;   // the same by how well they agree too, less chance and what the prior says
  int looked_at = 0;   // places with an unmatched point of the map, in a second look; 0: none taken
  int recognised = 0;  // of them, and counted in `evidence`
  int cells = 0;       // of the 4x4 of the image that hold an inlier
  int visible = 0;     // features of the image with a projected map point within 8 px
  int expected = 0;    // of them, those with one that was seen much as now; 0 when accepted
  int signatures = 0;  // candidates that were looked at
  SignatureId nearest = 0;  // signature nearest to the prior, when there is one
  ZoneId nearest_zone = kNoZone;
  double nearest_m = 0;         // its distance
  double nearest_turn_rad = 0;  // how far it looks to the side of the prior's view
  SignatureId best = 0;         // signature with most inliers
  ZoneId best_zone = kNoZone;
  double residual_px = 0;  // root mean square of the inliers
  std::array<std::int64_t, kStages> cpu_ns{};
  std::int64_t cpu_total_ns = 0;
  std::vector<DrawnMatch> drawn;  // when QueryOptions::keep_matches
};

}  // namespace zonepack::localize
