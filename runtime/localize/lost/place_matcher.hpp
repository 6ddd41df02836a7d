// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "runtime/localize/lost/lost_view.hpp"
#include "runtime/localize/query/localizer.hpp"

namespace zonepack::localize {

// What a search for a lost robot asks about one view and the signatures of one zone.
class PlaceMatcher {
 public:
  virtual ~PlaceMatcher() = default;

  // Places that the view may show, most inliers first, a few at most. 0.3 ms a signature and a
  // few ms a place.
  virtual std::vector<Sight> guess(const LostView& view, ZoneId zone,
                                   std::span<const MapFeatures* const> map) = 0;

  // Whether the view shows what the zone has near the prior: the best place there. Nothing when the
  // zone has nothing to see there, or the view nothing to compare.
  virtual std::optional<Sight> check(const LostView& view, ZoneId zone,
                                     std::span<const MapFeatures* const> map,
                                     const QueryPrior& prior) = 0;
};

// The same by a localizer: brute force over each signature, RANSAC on the plane, and for the best
// places the query around a prior.
class ImageMatcher final : public PlaceMatcher {
 public:
  static constexpr std::size_t kMostPlaces = 3;

  // Must outlive this object.
  ImageMatcher(Localizer& localizer, const DetectorSettings& detector);

  std::vector<Sight> guess(const LostView& view, ZoneId zone,
                           std::span<const MapFeatures* const> map) override;
  std::optional<Sight> check(const LostView& view, ZoneId zone,
                             std::span<const MapFeatures* const> map,
                             const QueryPrior& prior) override;

 private:
  Localizer& localizer_;
  bool binary_;
};

}  // namespace zonepack::localize
