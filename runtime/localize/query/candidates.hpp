// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/localize/camera/camera_model.hpp"
#include "runtime/localize/query/map_features.hpp"
#include "runtime/localize/query/query_result.hpp"

namespace zonepack::localize {

// A signature that a query looks at.
struct Candidate {
  const MapFeatures* map = nullptr;
  std::uint32_t in_view = 0;  // of its points, estimated: those that the prior's camera should see
};

struct Candidates {
  std::vector<Candidate> best;   // most points in view first, at most `most`
  std::vector<Candidate> reach;  // all with a point in view, the best among them first
  std::uint32_t near = 0;        // signatures in reach, whatever they see
  const MapFeatures* nearest = nullptr;
  double nearest_m = 0, nearest_turn_rad = 0;
  double floor_z_m = 0;  // of the best, weighted by points in view
};

// Signatures with points that a camera at the prior should see about as the signature's own camera
// did: at 0.4 to 2.5 times its distance, from a side at most 70 degrees away.
Candidates choose_candidates(std::span<const MapFeatures* const> map, const CameraModel& camera,
                             const QueryPrior& prior, std::size_t most);

// Poses that span a prior: the prior itself, and one step of a standard deviation along each axis
// of its covariance in both directions.
std::array<Pose2, 7> spanning_poses(const QueryPrior& prior);

}  // namespace zonepack::localize
