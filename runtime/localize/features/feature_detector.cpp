// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/features/feature_detector.hpp"

#include <algorithm>
#include <cstring>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "platform/base/require.hpp"
#include "platform/process/clock.hpp"
#include "runtime/localize/features/banded_corners.hpp"
#include "runtime/localize/features/orb_comparisons.hpp"

namespace zonepack::localize {
namespace {

// OpenCV has no matrix of constant bytes; nobody writes to this one.
cv::Mat pixels_of(const GreyImage& image) {
  return {image.height, image.width, CV_8UC1,
          const_cast<std::uint8_t*>(image.pixels.data())};  // NOLINT
}

}  // namespace

struct FeatureDetector::OpenCv {
  cv::Ptr<cv::Feature2D> finder, describer;
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
  std::optional<OrbComparisons> comparisons;
  bool comparisons_read = false;

  // Null: OpenCV describes.
  OrbComparisons* read_comparisons(const DetectorSettings& settings) {
    if (!comparisons_read && settings.wta_k == 2) {
      comparisons = OrbComparisons::read(*describer, settings.patch_px, settings.edge_px);
    }
    comparisons_read = true;
    return comparisons ? &*comparisons : nullptr;
  }
};

FeatureDetector::FeatureDetector(const DetectorSettings& s)
    : settings_(s), cv_(std::make_unique<OpenCv>()) {
  cv::setNumThreads(1);
  const auto orb = [&] {
    return cv::ORB::create(s.max_features, static_cast<float>(s.scale_factor), s.levels, s.edge_px,
                           s.first_level, s.wta_k,
                           s.fast_score ? cv::ORB::FAST_SCORE : cv::ORB::HARRIS_SCORE, s.patch_px,
                           s.fast_threshold);
  };
  switch (s.detector) {
    case Detector::kGfttOrb:
      cv_->finder = cv::makePtr<BandedCorners>(s);
      cv_->describer = orb();
      break;
    case Detector::kOrb:
      cv_->finder = cv_->describer = orb();
      break;
    case Detector::kSift:
      cv_->finder = cv_->describer =
          cv::SIFT::create(s.max_features, s.octave_layers, s.contrast, s.edge_ratio, s.sigma);
      break;
    case Detector::kBrisk:
      cv_->finder = cv_->describer =
          cv::BRISK::create(s.brisk_threshold, s.brisk_octaves, static_cast<float>(s.brisk_scale));
      break;
  }
}

FeatureDetector::~FeatureDetector() = default;

ImageFeatures FeatureDetector::detect(const GreyImage& image, const CameraModel& camera) {
  ZP_REQUIRE(image.whole());
  ImageFeatures out;
  out.width = image.width;
  out.height = image.height;
  out.stamp_ns = image.stamp_ns;
  out.descriptor_bytes = settings_.descriptor_bytes();
  const cv::Mat pixels = pixels_of(image);
  const std::int64_t begin = thread_cpu_ns();
  cv_->finder->detect(pixels, cv_->keypoints);
  const auto most = static_cast<std::size_t>(settings_.max_features);
  if (cv_->keypoints.size() > most)
    cv::KeyPointsFilter::retainBest(cv_->keypoints, settings_.max_features);
  const std::int64_t found = thread_cpu_ns();
  cv_->describer->compute(pixels, cv_->keypoints, cv_->descriptors);
  const std::size_t count = cv_->keypoints.size();
  ZP_REQUIRE(count == 0 || cv_->descriptors.cols * static_cast<int>(cv_->descriptors.elemSize()) ==
                               static_cast<int>(out.descriptor_bytes));
  std::vector<std::pair<Eigen::Vector2f, int>> order;
  order.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2f seen(cv_->keypoints[i].pt.x, cv_->keypoints[i].pt.y);
    order.emplace_back(camera.ideal(seen), static_cast<int>(i));
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first.x() < b.first.x(); });
  out.seen_px.reserve(count);
  out.px.reserve(count);
  out.descriptors.resize(count * out.descriptor_bytes);
  for (std::size_t i = 0; i < count; ++i) {
    const cv::KeyPoint& keypoint = cv_->keypoints[static_cast<std::size_t>(order[i].second)];
    out.seen_px.emplace_back(keypoint.pt.x, keypoint.pt.y);
    out.px.push_back(order[i].first);
    std::memcpy(out.descriptors.data() + i * out.descriptor_bytes,
                cv_->descriptors.ptr(order[i].second), out.descriptor_bytes);
  }
  out.detect_ns = found - begin;
  out.describe_ns = thread_cpu_ns() - found;
  return out;
}

PlaceDescriber::PlaceDescriber(FeatureDetector& detector, const GreyImage& image)
    : image_(image), settings_(detector.settings()), cv_(*detector.cv_) {
  ZP_REQUIRE(image.whole() && detector.describes_anywhere());
}

PlaceDescriber::~PlaceDescriber() {
  if (comparisons_ != nullptr) comparisons_->release();
}

const OrbComparisons* PlaceDescriber::prepared() {
  if (!prepared_) {
    comparisons_ = cv_.read_comparisons(settings_);
    if (comparisons_ != nullptr) comparisons_->use(pixels_of(image_));
    prepared_ = true;
  }
  return comparisons_;
}

DescribedPlaces PlaceDescriber::places(std::span<const Eigen::Vector2f> px) {
  DescribedPlaces out;
  out.descriptor_bytes = settings_.descriptor_bytes();
  out.row_of.assign(px.size(), -1);
  if (const OrbComparisons* comparisons = prepared()) {
    out.rows.resize(px.size() * out.descriptor_bytes);
    std::int32_t row = 0;
    for (std::size_t i = 0; i < px.size(); ++i) {
      std::uint8_t* at = out.rows.data() + static_cast<std::size_t>(row) * out.descriptor_bytes;
      if (comparisons->place(px[i].x(), px[i].y(), at)) out.row_of[i] = row++;
    }
    return out;
  }
  cv_.keypoints.clear();
  for (std::size_t i = 0; i < px.size(); ++i) {
    cv_.keypoints.push_back(undirected_keypoint(px[i].x(), px[i].y(), static_cast<int>(i)));
  }
  cv_.describer->compute(pixels_of(image_), cv_.keypoints, cv_.descriptors);
  out.rows.resize(cv_.keypoints.size() * out.descriptor_bytes);
  for (std::size_t row = 0; row < cv_.keypoints.size(); ++row) {
    out.row_of[static_cast<std::size_t>(cv_.keypoints[row].class_id)] =
        static_cast<std::int32_t>(row);
    std::memcpy(out.rows.data() + row * out.descriptor_bytes,
                cv_.descriptors.ptr(static_cast<int>(row)), out.descriptor_bytes);
  }
  return out;
}

DescribedGrid PlaceDescriber::grid(int step_px) {
  ZP_REQUIRE(step_px > 0);
  DescribedGrid out;
  out.descriptor_bytes = settings_.descriptor_bytes();
  out.step_px = step_px;
  out.first_px = (settings_.edge_px + step_px - 1) / step_px * step_px;
  const auto places_along = [&](int size) {
    return std::max(0, (size - settings_.edge_px - 1 - out.first_px) / step_px + 1);
  };
  if (image_.width <= 2 * settings_.edge_px || image_.height <= 2 * settings_.edge_px) return out;
  out.columns = places_along(image_.width);
  out.rows = places_along(image_.height);
  const auto count = static_cast<std::size_t>(out.columns) * static_cast<std::size_t>(out.rows);
  out.descriptors.resize(count * out.descriptor_bytes);
  if (const OrbComparisons* comparisons = prepared()) {
    comparisons->grid(out.first_px, step_px, out.columns, out.rows, out.descriptors.data());
    return out;
  }
  std::vector<Eigen::Vector2f> px;
  px.reserve(count);
  for (int row = 0; row < out.rows; ++row) {
    for (int column = 0; column < out.columns; ++column) {
      px.emplace_back(static_cast<float>(out.first_px + column * step_px),
                      static_cast<float>(out.first_px + row * step_px));
    }
  }
  const DescribedPlaces described = places(px);
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(out.descriptors.data() + i * out.descriptor_bytes, described.find(i),
                out.descriptor_bytes);
  }
  return out;
}

}  // namespace zonepack::localize
