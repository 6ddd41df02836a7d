// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/query/localizer.hpp"

#include "runtime/localize/query/localizer_state.hpp"

namespace zonepack::localize {

Localizer::Localizer(const CameraModel& camera, const DetectorSettings& detector,
                     const QueryOptions& options)
    : state_(new State{camera, FeatureDetector(detector), options, camera.fx / kUsualFocal_px}) {}
Localizer::~Localizer() = default;
Localizer::Localizer(Localizer&&) noexcept = default;
Localizer& Localizer::operator=(Localizer&&) noexcept = default;

const CameraModel& Localizer::camera() const noexcept { return state_->camera; }
QueryOptions& Localizer::options() noexcept { return state_->options; }

std::optional<ImageFeatures> Localizer::detect(const GreyImage& image) {
  if (!image.whole() || image.width != state_->camera.width ||
      image.height != state_->camera.height) {
    return std::nullopt;
  }
  return state_->detector.detect(image, state_->camera);
}

QueryResult Localizer::locate(const ImageFeatures& image, std::span<const MapFeatures* const> map,
                              const std::optional<QueryPrior>& prior, const GreyImage* pixels) {
  QueryResult result;
  result.features = static_cast<int>(image.size());
  if (result.features < state_->options.needed) {
    result.reason = Reason::kNoFeatures;
    return result;
  }
  if (prior) {
    state_->locate_near(image, pixels, map, *prior, result);
  } else {
    state_->locate_anywhere(image, map, result);
  }
  return result;
}

QueryResult Localizer::query(const GreyImage& image, std::span<const MapFeatures* const> map,
                             const std::optional<QueryPrior>& prior) {
  const auto features = detect(image);
  if (!features) {
    QueryResult result;
    result.reason = Reason::kWrongSize;
    return result;
  }
  QueryResult result = locate(*features, map, prior, &image);
  result.cpu_ns[static_cast<std::size_t>(Stage::kDetect)] = features->detect_ns;
  result.cpu_ns[static_cast<std::size_t>(Stage::kDescribe)] = features->describe_ns;
  result.cpu_total_ns += features->detect_ns + features->describe_ns;
  return result;
}

}  // namespace zonepack::localize
