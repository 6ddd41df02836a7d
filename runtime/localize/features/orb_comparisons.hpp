// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/features2d.hpp>
#include <optional>
#include <span>
#include <vector>

namespace zonepack::localize {

// As GFTT gives it: without direction, on the image itself.
inline cv::KeyPoint undirected_keypoint(float x_px, float y_px, int number) {
  return {x_px, y_px, 3, -1, 0, 0, number};
}

// What an ORB descriptor without direction consists of (Rublee et al., ICCV 2011): a bit for each
// pair of pixels around a place, set where the first is darker than the second, on an image
// smoothed by OpenCV's Gaussian of 7 pixels. OpenCV turns its pairs anew for every place that it
// describes; here they are read out of it once, by images with single bright and dark pixels, and
// describing a place takes a fifth of the time.
//
// Memory: a byte a pixel between use() and release(), another while a grid is described.
class OrbComparisons {
 public:
  // Of descriptors of 32 bytes whose bits compare two pixels (WTA_K 2) within `patch_px` around.
  // None if `orb` describes an image otherwise than these comparisons do. Some 20 ms.
  static std::optional<OrbComparisons> read(cv::Feature2D& orb, int patch_px, int edge_px);

  static constexpr int kBytes = 32;

  // Smooths an 8-bit image of one channel; place() and grid() are about the last one.
  void use(const cv::Mat& image);
  void release() { smoothed_.release(); }
  // What OpenCV gives for a keypoint there without direction. False, and nothing is written: nearer
  // to the border than OpenCV describes.
  bool place(float x_px, float y_px, std::uint8_t* out) const noexcept;
  // The same of each place in the `columns` and `rows` of a grid, row by row, into 32 bytes each:
  // the first at (first_px, first_px), the others `step_px` apart. All as far inside as place()
  // needs. Vector instructions compare a row at once: a twentieth of the time.
  void grid(int first_px, int step_px, int columns, int rows, std::uint8_t* out) const;

 private:
  struct Pair {
    std::array<int, 2> x, y;
  };
  explicit OrbComparisons(int edge_px) : edge_px_(edge_px) {}
  bool find_pairs(cv::Feature2D& orb, int reach_px);
  bool agrees_with(cv::Feature2D& orb);

  int edge_px_;
  std::vector<Pair> pairs_;
  std::vector<std::array<int, 2>> offsets_;  // of the pairs' pixels, in an image of this width
  cv::Mat smoothed_;
};

}  // namespace zonepack::localize
