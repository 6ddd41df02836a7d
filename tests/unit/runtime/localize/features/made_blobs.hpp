// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace zonepack::localize {

// Blobs of all sizes and greys: noise, smoothed.
inline cv::Mat made_blobs(int width, int height, std::uint64_t seed, double sigma_px) {
  cv::Mat noise(height, width, CV_8UC1), image;
  cv::RNG random(seed);
  random.fill(noise, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(noise, image, {0, 0}, sigma_px);
  cv::normalize(image, image, 0, 255, cv::NORM_MINMAX);
  return image;
}

}  // namespace zonepack::localize
