// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <span>

#include "runtime/localize/camera/camera_model.hpp"
#include "runtime/localize/camera/grey_image.hpp"
#include "runtime/localize/features/feature_detector.hpp"
#include "runtime/localize/query/candidates.hpp"
#include "runtime/localize/solve/sighting.hpp"

namespace zonepack::localize {

struct SecondLook {
  int points = 0;      // places of the image that show something, and that the map has a point at
  int recognised = 0;  // of them
};

// Looks again where a camera at the pose would see points of the map that are not among `matched`,
// whether the detector found a corner there or not, and at eight places around each. A point is
// recognised if it looks more like what is there than like anything around it, by 20 of 256 bits:
// blank walls and covered parts of the view are never recognised, a patterned floor is now and then
// where it is not. At most 60 points, of the 12 candidates that come first, those first that were
// seen from about where the camera is. Some 4 million instructions.
//
// `describer` is of the image.
SecondLook take_second_look(PlaceDescriber& describer, std::span<const Candidate> candidates,
                            const CameraModel& camera, const Eigen::Isometry3d& T_map_base,
                            std::span<const Sighting> matched);

}  // namespace zonepack::localize
