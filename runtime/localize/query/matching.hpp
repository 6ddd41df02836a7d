// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "runtime/localize/camera/camera_model.hpp"
#include "runtime/localize/features/image_features.hpp"
#include "runtime/localize/query/candidates.hpp"
#include "runtime/localize/solve/sighting.hpp"

namespace zonepack::localize {

struct MatchOptions {
  bool binary = true;         // descriptors are compared bit by bit; else as floats
  double most_distance = 64;  // between descriptors, of 256 bits; scaled for other lengths
  double ratio = 0.85;        // to the second best in the window
  double sigmas = 2.5;        // width of the window
  double margin_px = 14;      // what tilt and the map's own errors add to it
};

// How sure a match is whose descriptors differ in so many of 256 bits, 0.05 to 1: 30 differ in most
// right matches, 85 in few.
double weight_of_match(double distance) noexcept;

// Matches each candidate's points with the image's features inside the window where the prior lets
// them be: nearest descriptor, clearly nearer than the second, and in both directions. Sorted by
// feature.
std::vector<Sighting> match_in_windows(const ImageFeatures& image,
                                       std::span<const Candidate> candidates,
                                       const CameraModel& camera, const QueryPrior& prior,
                                       double floor_z_m, const MatchOptions& options);

// Matches all points that a camera at the pose sees with the features within `radius_px` of where
// it sees them. Of several points of one signature the best stays with a feature, and of several
// features with a point. Sorted by feature.
std::vector<Sighting> match_projected(const ImageFeatures& image,
                                      std::span<const Candidate> candidates,
                                      const CameraModel& camera,
                                      const Eigen::Isometry3d& T_map_base, double radius_px,
                                      const MatchOptions& options);

// Matches one signature with the whole image: nearest in both directions and clearly nearer than
// the second. Sorted by feature.
std::vector<Sighting> match_everywhere(const ImageFeatures& image, const MapFeatures& map,
                                       const MatchOptions& options);

// Features of the image that have a projected point of a candidate within `radius_px`; with
// `most_change`, a point whose view_change() is at most that.
int count_visible(const ImageFeatures& image, std::span<const Candidate> candidates,
                  const CameraModel& camera, const Eigen::Isometry3d& T_map_base, double radius_px,
                  std::optional<double> most_change = {});

}  // namespace zonepack::localize
