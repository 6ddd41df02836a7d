// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/features/orb_comparisons.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace zonepack::localize {
namespace {

constexpr int kKernel_px = 7, kKernelReach_px = kKernel_px / 2;
constexpr std::size_t kBits = std::size_t{OrbComparisons::kBytes} * 8;
// Places of a grid that are compared at once: GCC's and clang's vectors, for any processor.
constexpr std::size_t kAbreast = 16;
using Abreast [[gnu::vector_size(kAbreast)]] = std::uint8_t;

// The pixels that, bright or dark, set a bit: those nearer to the place that it looks for than to
// the other one of the pair, as far as smoothing carries them.
struct Extent {
  int least_x = 1000, most_x = -1000, least_y = 1000, most_y = -1000;
  void add(int x, int y) {
    least_x = std::min(least_x, x), most_x = std::max(most_x, x);
    least_y = std::min(least_y, y), most_y = std::max(most_y, y);
  }
};

// Along one axis: on the side away from the pair's other pixel nothing is missing.
int middle(int least, int most, int other_most) {
  return most < other_most ? least + kKernelReach_px : most - kKernelReach_px;
}

}  // namespace

std::optional<OrbComparisons> OrbComparisons::read(cv::Feature2D& orb, int patch_px, int edge_px) {
  OrbComparisons out(edge_px);
  const int reach_px = patch_px / 2 + 2 + kKernelReach_px;  // turning by a degree moves a corner
  if (edge_px < patch_px / 2 + 2 || orb.descriptorSize() != kBytes) return std::nullopt;
  if (!out.find_pairs(orb, reach_px) || !out.agrees_with(orb)) return std::nullopt;
  return out;
}

// In strips of three rows of places, far enough apart that none sees the pixel of another.
bool OrbComparisons::find_pairs(cv::Feature2D& orb, int reach_px) {
  constexpr int kRows = 3;
  const int pitch = 2 * reach_px + 1, margin = edge_px_ + reach_px;
  const auto number = [&](int x, int y) { return (y + reach_px) * pitch + x + reach_px; };
  std::vector<Extent> first(kBits), second(kBits);
  std::vector<cv::KeyPoint> places;
  cv::Mat descriptors;
  for (const bool bright : {false, true}) {
    for (int top = -reach_px; top <= reach_px; top += kRows) {
      cv::Mat strip(kRows * pitch + 2 * margin, pitch * pitch + 2 * margin, CV_8UC1,
                    cv::Scalar(bright ? 0 : 255));
      places.clear();
      for (int y = top; y < std::min(top + kRows, reach_px + 1); ++y) {
        for (int x = -reach_px; x <= reach_px; ++x) {
          const int column = margin + (x + reach_px) * pitch + reach_px;
          const int row = margin + (y - top) * pitch + reach_px;
          strip.at<std::uint8_t>(row + y, column + x) = bright ? 255 : 0;
          places.push_back(undirected_keypoint(static_cast<float>(column), static_cast<float>(row),
                                               number(x, y)));
        }
      }
      orb.compute(strip, places, descriptors);
      for (std::size_t p = 0; p < places.size(); ++p) {
        const int x = places[p].class_id % pitch - reach_px;
        const int y = places[p].class_id / pitch - reach_px;
        const std::uint8_t* bits = descriptors.ptr(static_cast<int>(p));
        for (std::size_t bit = 0; bit < kBits; ++bit) {
          if ((bits[bit / 8] >> (bit % 8) & 1) != 0) (bright ? second : first)[bit].add(x, y);
        }
      }
    }
  }
  for (std::size_t bit = 0; bit < kBits; ++bit) {
    const Extent &a = first[bit], &b = second[bit];
    if (a.most_x < a.least_x || b.most_x < b.least_x) return false;
    pairs_.push_back(
        {{middle(a.least_x, a.most_x, b.most_x), middle(b.least_x, b.most_x, a.most_x)},
         {middle(a.least_y, a.most_y, b.most_y), middle(b.least_y, b.most_y, a.most_y)}});
  }
  return true;
}

bool OrbComparisons::agrees_with(cv::Feature2D& orb) {
  const int size = 2 * edge_px_ + 40;
  cv::Mat noise(size, size, CV_8UC1);
  std::uint32_t state = 1;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      state = state * 1664525 + 1013904223;
      noise.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(state >> 24);
    }
  }
  std::vector<cv::KeyPoint> places;
  for (int at = edge_px_; at < size - edge_px_; ++at) {
    places.push_back(
        undirected_keypoint(static_cast<float>(at), static_cast<float>(size - 1 - at), at));
  }
  cv::Mat descriptors;
  orb.compute(noise, places, descriptors);
  use(noise);
  if (static_cast<int>(places.size()) != size - 2 * edge_px_) return false;
  for (std::size_t p = 0; p < places.size(); ++p) {
    std::array<std::uint8_t, kBytes> mine{};
    if (!place(places[p].pt.x, places[p].pt.y, mine.data())) return false;
    if (!std::equal(mine.begin(), mine.end(), descriptors.ptr(static_cast<int>(p)))) return false;
  }
  return true;
}

void OrbComparisons::use(const cv::Mat& image) {
  // Of a part of an image OpenCV rounds the sums otherwise than of a whole one; ORB smooths a part.
  cv::Mat framed;
  cv::copyMakeBorder(image, framed, kKernelReach_px, kKernelReach_px, kKernelReach_px,
                     kKernelReach_px, cv::BORDER_REFLECT_101);
  const cv::Mat part = framed(cv::Rect(kKernelReach_px, kKernelReach_px, image.cols, image.rows));
  cv::GaussianBlur(part, smoothed_, {kKernel_px, kKernel_px}, 2, 2, cv::BORDER_REFLECT_101);
  const auto step = static_cast<int>(smoothed_.step1());
  offsets_.clear();
  for (const Pair& pair : pairs_) {
    offsets_.push_back({pair.y[0] * step + pair.x[0], pair.y[1] * step + pair.x[1]});
  }
}

bool OrbComparisons::place(float x_px, float y_px, std::uint8_t* out) const noexcept {
  const int x = cvRound(x_px), y = cvRound(y_px);
  if (x < edge_px_ || y < edge_px_ || x >= smoothed_.cols - edge_px_ ||
      y >= smoothed_.rows - edge_px_) {
    return false;
  }
  const std::uint8_t* here = smoothed_.ptr(y) + x;
  const std::array<int, 2>* offset = offsets_.data();
  for (int byte = 0; byte < kBytes; ++byte) {
    unsigned bits = 0;
    for (unsigned bit = 0; bit < 8; ++bit, ++offset) {
      bits |= static_cast<unsigned>(here[(*offset)[0]] < here[(*offset)[1]]) << bit;
    }
    out[byte] = static_cast<std::uint8_t>(bits);
  }
  return true;
}

// A plane for each place between the steps holds every step_px-th pixel of the image: what a
// comparison needs of a row of the grid lies side by side in two of them.
void OrbComparisons::grid(int first_px, int step_px, int columns, int rows,
                          std::uint8_t* out) const {
  // The last of kAbreast places that are compared at once may lie beyond the last column.
  const int wide = smoothed_.cols / step_px + 1, high = smoothed_.rows / step_px + 1;
  const auto plane_bytes = static_cast<std::size_t>(wide) * static_cast<std::size_t>(high);
  std::vector<std::uint8_t> planes(plane_bytes * static_cast<std::size_t>(step_px * step_px) +
                                   kAbreast);
  const auto plane_of = [&](int x, int y) {
    return planes.data() +
           plane_bytes * static_cast<std::size_t>(y % step_px * step_px + x % step_px);
  };
  for (int y = 0; y < smoothed_.rows; ++y) {
    const std::uint8_t* line = smoothed_.ptr(y);
    for (int left = 0; left < step_px; ++left) {
      std::uint8_t* to = plane_of(left, y) + y / step_px * wide;
      for (int x = left; x < smoothed_.cols; x += step_px) *to++ = line[x];
    }
  }
  const auto row_of = [&](int x, int y) {
    return plane_of(x, y) + y / step_px * wide + x / step_px;
  };
  const auto count = static_cast<std::size_t>(columns);
  std::vector<const std::uint8_t*> pixels(2 * pairs_.size());  // of each comparison, in a row
  for (int row = 0; row < rows; ++row) {
    const int y = first_px + row * step_px;
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      pixels[2 * p] = row_of(first_px + pairs_[p].x[0], y + pairs_[p].y[0]);
      pixels[2 * p + 1] = row_of(first_px + pairs_[p].x[1], y + pairs_[p].y[1]);
    }
    std::uint8_t* const descriptors = out + static_cast<std::size_t>(row) * count * kBytes;
    for (std::size_t first = 0; first < count; first += kAbreast) {
      const std::size_t here = std::min(kAbreast, count - first);
      for (std::size_t byte = 0; byte < kBytes; ++byte) {
        Abreast bits{};
        for (std::size_t bit = 0; bit < 8; ++bit) {
          Abreast a, b;
          std::memcpy(&a, pixels[2 * (byte * 8 + bit)] + first, kAbreast);
          std::memcpy(&b, pixels[2 * (byte * 8 + bit) + 1] + first, kAbreast);
          bits |= reinterpret_cast<Abreast>(a < b) & static_cast<std::uint8_t>(1U << bit);
        }
        for (std::size_t i = 0; i < here; ++i) descriptors[(first + i) * kBytes + byte] = bits[i];
      }
    }
  }
}

}  // namespace zonepack::localize
