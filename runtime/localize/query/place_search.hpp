// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "runtime/localize/camera/camera_model.hpp"
#include "runtime/localize/camera/grey_image.hpp"
#include "runtime/localize/features/feature_detector.hpp"
#include "runtime/localize/query/candidates.hpp"
#include "runtime/localize/query/matching.hpp"
#include "runtime/localize/solve/sighting.hpp"

namespace zonepack::localize {

// Finds the map in an image without the detector: a blurred, overexposed or noisy image has other
// corners than those that the map was made of, but the places of the map's points still look like
// them. The image is described at every fourth pixel (some 20,000 places, farther apart in a larger
// image), and each point that the prior's camera should see is looked for in its window. A place is
// taken if its descriptor is the nearest to the point's, and clearly nearer than that of any place
// more than 10 px away; then the best pixel next to it. At most 120 points, of the best candidates,
// those first that were seen from about where the camera is. Some 30 million instructions.
//
// Appends what it found to the features of `image`, which are no longer sorted, and gives a match
// for each, sorted by feature. `describer` is of the image.
std::vector<Sighting> find_places(PlaceDescriber& describer, const Candidates& candidates,
                                  const CameraModel& camera, const QueryPrior& prior,
                                  const MatchOptions& options, ImageFeatures& image);

}  // namespace zonepack::localize
