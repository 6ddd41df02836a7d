// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/features2d.hpp>

#include "runtime/localize/features/detector_settings.hpp"

namespace zonepack::localize {

// "Good features to track" (Shi and Tomasi, CVPR 1994) as OpenCV's GFTTDetector finds them: corners
// where the smaller eigenvalue of the gradients' matrix (or Harris' measure) is largest, strongest
// first, none closer to a stronger one than the least distance. OpenCV keeps the gradients and
// their products of the whole image at once, 24 bytes a pixel; this goes through it in bands of
// rows and keeps 4.
//
// Threads: one at a time.
// Memory: 4 bytes a pixel, and 24 a pixel of one band.
class BandedCorners final : public cv::Feature2D {
 public:
  explicit BandedCorners(const DetectorSettings& settings) : settings_(settings) {}

  // An 8-bit image of one channel; `mask` must be empty.
  void detect(cv::InputArray image, std::vector<cv::KeyPoint>& keypoints,
              cv::InputArray mask = cv::noArray()) override;

 private:
  void measure(const cv::Mat& image);
  void list_peaks(float least);

  DetectorSettings settings_;
  cv::Mat strength_, band_;
  std::vector<const float*> peaks_;
  std::vector<std::vector<cv::Point2f>> grid_;  // of cells as wide as the least distance
};

}  // namespace zonepack::localize
