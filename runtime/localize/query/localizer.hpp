// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "runtime/localize/camera/camera_model.hpp"
#include "runtime/localize/camera/grey_image.hpp"
#include "runtime/localize/features/detector_settings.hpp"
#include "runtime/localize/features/image_features.hpp"
#include "runtime/localize/query/map_features.hpp"
#include "runtime/localize/query/query_result.hpp"

namespace zonepack::localize {

struct QueryOptions {
  int needed = 8;             // distinct inliers
  int needed_cells = 4;       // of the 4x4 of the image
  std::uint64_t seed = 1;     // of RANSAC: the same seed, the same result
  bool keep_matches = false;  // fill QueryResult::drawn
};

// Finds the pose of a camera among signatures of the map.
//
// Threads: one at a time.
// Memory: buffers of an image and its features; grows with the largest image and number of
// candidates.
class Localizer {
 public:
  Localizer(const CameraModel& camera, const DetectorSettings& detector,
            const QueryOptions& options = {});
  ~Localizer();
  Localizer(Localizer&&) noexcept;
  Localizer& operator=(Localizer&&) noexcept;

  // `map`: the signatures that are resident; those out of reach of the prior cost little. Without a
  // prior every signature is tried by brute force, and the place that explains the image best is
  // taken: 0.3 ms a signature.
  QueryResult query(const GreyImage& image, std::span<const MapFeatures* const> map,
                    const std::optional<QueryPrior>& prior);

  // The same in two steps, for a search that tries many zones with buffered views. Without the
  // image, what the detector found is all there is: no places are found in it (place_search.hpp),
  // and there is no second look at it (second_look.hpp), when the evidence is not enough.
  // detect() gives none for an image that is not of the calibration's size.
  std::optional<ImageFeatures> detect(const GreyImage& image);
  QueryResult locate(const ImageFeatures& features, std::span<const MapFeatures* const> map,
                     const std::optional<QueryPrior>& prior, const GreyImage* image = nullptr);

  const CameraModel& camera() const noexcept;
  QueryOptions& options() noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Whether a signature could have features in the view of a robot at the prior: for callers that
// copy only what a query can use.
bool in_reach(const Eigen::Isometry3d& T_map_base, const QueryPrior& prior) noexcept;

}  // namespace zonepack::localize
