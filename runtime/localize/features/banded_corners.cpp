// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/features/banded_corners.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "platform/base/require.hpp"

namespace zonepack::localize {
namespace {

constexpr int kBandRows = 32;
constexpr int kSobel = 3;

}  // namespace

void BandedCorners::measure(const cv::Mat& image) {
  strength_.create(image.size(), CV_32FC1);
  // The sums over a block reach this far; what a band lacks at its edges is in its neighbours.
  const int reach = settings_.block_px / 2 + 1;
  for (int first = 0; first < image.rows; first += kBandRows) {
    const int last = std::min(first + kBandRows, image.rows);
    const int from = std::max(first - reach, 0);
    const int to = std::min(last + reach, image.rows);
    const cv::Mat rows = image.rowRange(from, to);
    if (settings_.harris) {
      cv::cornerHarris(rows, band_, settings_.block_px, kSobel, settings_.harris_k);
    } else {
      cv::cornerMinEigenVal(rows, band_, settings_.block_px, kSobel);
    }
    band_.rowRange(first - from, last - from).copyTo(strength_.rowRange(first, last));
  }
}

// Those that are not below any of their eight neighbours, and not at the image's edge.
void BandedCorners::list_peaks(float least) {
  peaks_.clear();
  for (int y = 1; y + 1 < strength_.rows; ++y) {
    const float* const above = strength_.ptr<float>(y - 1);
    const float* const here = strength_.ptr<float>(y);
    const float* const below = strength_.ptr<float>(y + 1);
    for (int x = 1; x + 1 < strength_.cols; ++x) {
      const float value = here[x];
      if (value <= least || value < here[x - 1] || value < here[x + 1]) continue;
      const auto over = [value, x](const float* row) {
        return value >= row[x - 1] && value >= row[x] && value >= row[x + 1];
      };
      if (over(above) && over(below)) peaks_.push_back(here + x);
    }
  }
  std::sort(peaks_.begin(), peaks_.end(), [](const float* a, const float* b) {
    return *a != *b ? *a > *b : a > b;  // of equal ones the later: as OpenCV does
  });
}

void BandedCorners::detect(cv::InputArray image, std::vector<cv::KeyPoint>& keypoints,
                           cv::InputArray mask) {
  ZP_REQUIRE(mask.empty() && image.type() == CV_8UC1);
  keypoints.clear();
  if (image.empty()) return;
  measure(image.getMat());
  double strongest = 0;
  cv::minMaxLoc(strength_, nullptr, &strongest);
  // A measure below 0 or of 0 is no corner, however weak the strongest is.
  list_peaks(std::max(0.0F, static_cast<float>(strongest * settings_.quality)));

  const auto most = static_cast<std::size_t>(settings_.max_features);
  const double apart = settings_.min_distance_px;
  const int cell = std::max(1, cvRound(apart));
  const int columns = (strength_.cols + cell - 1) / cell;
  const int rows = (strength_.rows + cell - 1) / cell;
  grid_.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (auto& one : grid_) one.clear();
  const auto at = [&](int column, int row) -> std::vector<cv::Point2f>& {
    return grid_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                 static_cast<std::size_t>(column)];
  };
  const auto too_close = [&](const cv::Point2f& point, int column, int row) {
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, rows - 1); ++r) {
      for (int c = std::max(column - 1, 0); c <= std::min(column + 1, columns - 1); ++c) {
        for (const cv::Point2f& taken : at(c, r)) {
          const float dx = point.x - taken.x, dy = point.y - taken.y;
          if (static_cast<double>(dx * dx + dy * dy) < apart * apart) return true;
        }
      }
    }
    return false;
  };
  for (const float* const peak : peaks_) {
    if (keypoints.size() == most) break;
    const auto offset = static_cast<int>(peak - strength_.ptr<float>());
    const int x = offset % strength_.cols, y = offset / strength_.cols;
    const cv::Point2f point(static_cast<float>(x), static_cast<float>(y));
    if (apart >= 1) {
      if (too_close(point, x / cell, y / cell)) continue;
      at(x / cell, y / cell).push_back(point);
    }
    keypoints.emplace_back(point, static_cast<float>(settings_.block_px), -1.0F, *peak);
  }
}

}  // namespace zonepack::localize
