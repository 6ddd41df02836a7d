// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "runtime/localize/camera/grey_image.hpp"

// What a day does to a camera's images.
namespace zonepack::test_support {

using localize::GreyImage;

inline std::uint8_t to_byte(double value) {
  return static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
}

inline GreyImage each_pixel(GreyImage image, const std::function<double(double)>& change) {
  std::uint8_t table[256];
  for (int i = 0; i < 256; ++i) table[i] = to_byte(change(i));
  for (std::uint8_t& pixel : image.pixels) pixel = table[pixel];
  return image;
}

inline GreyImage gain(const GreyImage& image, double factor) {
  return each_pixel(image, [&](double v) { return v * factor; });
}

inline GreyImage gamma(const GreyImage& image, double exponent) {
  return each_pixel(image, [&](double v) { return 255 * std::pow(v / 255, exponent); });
}

inline GreyImage noise(GreyImage image, double sigma, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> error(0, sigma);
  for (std::uint8_t& pixel : image.pixels) pixel = to_byte(pixel + error(random));
  return image;
}

// Along one axis, with these weights; the border is repeated.
inline GreyImage along(const GreyImage& image, const std::vector<double>& weights, int dx, int dy) {
  GreyImage out = image;
  const int half = static_cast<int>(weights.size()) / 2;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      double sum = 0;
      for (int k = 0; k < static_cast<int>(weights.size()); ++k) {
        const int at_x = std::clamp(x + dx * (k - half), 0, image.width - 1);
        const int at_y = std::clamp(y + dy * (k - half), 0, image.height - 1);
        sum += weights[static_cast<std::size_t>(k)] *
               image.pixels[static_cast<std::size_t>(at_y * image.width + at_x)];
      }
      out.pixels[static_cast<std::size_t>(y * image.width + x)] = to_byte(sum);
    }
  }
  return out;
}

inline GreyImage blur(const GreyImage& image, double sigma_px) {
  std::vector<double> weights;
  const int half = static_cast<int>(std::ceil(3 * sigma_px));
  double sum = 0;
  for (int i = -half; i <= half; ++i) {
    weights.push_back(std::exp(-i * i / (2 * sigma_px * sigma_px)));
    sum += weights.back();
  }
  for (double& weight : weights) weight /= sum;
  return along(along(image, weights, 1, 0), weights, 0, 1);
}

inline GreyImage motion_blur(const GreyImage& image, int px) {
  return along(image, std::vector<double>(static_cast<std::size_t>(px), 1.0 / px), 1, 0);
}

// The image as a camera gives it that compresses: blocks of 8x8 by the luminance table of JPEG's
// annex K, scaled for the quality as libjpeg does.
inline GreyImage jpeg_again(const GreyImage& image, int quality) {
  static constexpr int kTable[64] = {16,  11,  10,  16,  24, 40, 51,  61,  12,  12,  14,  19,  26,
                                     58,  60,  55,  14,  13, 16, 24,  40,  57,  69,  56,  14,  17,
                                     22,  29,  51,  87,  80, 62, 18,  22,  37,  56,  68,  109, 103,
                                     77,  24,  35,  55,  64, 81, 104, 113, 92,  49,  64,  78,  87,
                                     103, 121, 120, 101, 72, 92, 95,  98,  112, 100, 103, 99};
  const int scale = quality < 50 ? 5000 / quality : 200 - 2 * quality;
  double wave[8][8];  // [frequency][place]
  for (int f = 0; f < 8; ++f) {
    for (int x = 0; x < 8; ++x) {
      wave[f][x] =
          (f == 0 ? std::sqrt(0.125) : 0.5) * std::cos((2 * x + 1) * f * 0.19634954084936207);
    }
  }
  GreyImage out = image;
  for (int top = 0; top + 8 <= image.height; top += 8) {
    for (int left = 0; left + 8 <= image.width; left += 8) {
      const auto at = [&](int x, int y) {
        return static_cast<std::size_t>((top + y) * image.width + left + x);
      };
      double rows[8][8], both[8][8];
      for (int y = 0; y < 8; ++y) {
        for (int f = 0; f < 8; ++f) {
          rows[y][f] = 0;
          for (int x = 0; x < 8; ++x) rows[y][f] += wave[f][x] * (image.pixels[at(x, y)] - 128);
        }
      }
      for (int v = 0; v < 8; ++v) {
        for (int f = 0; f < 8; ++f) {
          both[v][f] = 0;
          for (int y = 0; y < 8; ++y) both[v][f] += wave[v][y] * rows[y][f];
          const int step = std::clamp((kTable[v * 8 + f] * scale + 50) / 100, 1, 255);
          both[v][f] = std::round(both[v][f] / step) * step;
        }
      }
      for (int y = 0; y < 8; ++y) {
        for (int f = 0; f < 8; ++f) {
          rows[y][f] = 0;
          for (int v = 0; v < 8; ++v) rows[y][f] += wave[v][y] * both[v][f];
        }
        for (int x = 0; x < 8; ++x) {
          double sum = 128;
          for (int f = 0; f < 8; ++f) sum += wave[f][x] * rows[y][f];
          out.pixels[at(x, y)] = to_byte(sum);
        }
      }
    }
  }
  return out;
}

// A grey box over the middle that covers this share of the image.
inline GreyImage cover(GreyImage image, double share) {
  const double side = std::sqrt(share);
  const int wide = static_cast<int>(image.width * side),
            high = static_cast<int>(image.height * side);
  const int left = (image.width - wide) / 2, top = (image.height - high) / 2;
  for (int y = top; y < top + high; ++y) {
    for (int x = left; x < left + wide; ++x) {
      image.pixels[static_cast<std::size_t>(y * image.width + x)] = 90;
    }
  }
  return image;
}

// Boxes of the image itself put elsewhere in it until they cover about this share: furniture that
// was moved.
inline GreyImage boxes(const GreyImage& image, double share, std::uint32_t seed) {
  GreyImage out = image;
  std::mt19937 random(seed);
  const auto below = [&](int most) {
    return static_cast<int>(random() % static_cast<unsigned>(most));
  };
  for (double covered = 0; covered < share * image.width * image.height;) {
    const int wide = 40 + below(120), high = 40 + below(120);
    const int from_x = below(image.width - wide), from_y = below(image.height - high);
    const int to_x = below(image.width - wide), to_y = below(image.height - high);
    for (int y = 0; y < high; ++y) {
      const auto from = image.pixels.begin() + (from_y + y) * image.width + from_x;
      std::copy(from, from + wide, out.pixels.begin() + (to_y + y) * image.width + to_x);
    }
    covered += wide * high;
  }
  return out;
}

// The gain of the frame-th image of a camera whose exposure drifts between a half and twice.
inline double drifting_gain(std::uint32_t frame) { return std::pow(2, std::sin(frame / 15.0)); }

inline GreyImage upside_down(GreyImage image) {
  std::reverse(image.pixels.begin(), image.pixels.end());
  return image;
}

inline GreyImage filled(GreyImage image, std::uint8_t value) {
  std::fill(image.pixels.begin(), image.pixels.end(), value);
  return image;
}

// "gain:2.5", "gamma:2", "blur:3", "motion:9", "noise:10", "jpeg:30", "cover:0.3", "boxes:0.15",
// "drift", "flip", "fill:0", and several joined by '+'; none for another word. `seed`: the frame's
// number.
inline std::optional<GreyImage> changed(const GreyImage& image, const std::string& change,
                                        std::uint32_t seed = 1) {
  const std::size_t plus = change.find('+');
  if (plus != std::string::npos) {
    const auto first = changed(image, change.substr(0, plus), seed);
    return first ? changed(*first, change.substr(plus + 1), seed) : std::nullopt;
  }
  const std::size_t colon = change.find(':');
  const std::string word = change.substr(0, colon);
  const double value = colon == std::string::npos ? 0 : std::atof(change.c_str() + colon + 1);
  if (word == "none") return image;
  if (word == "gain") return gain(image, value);
  if (word == "gamma") return gamma(image, value);
  if (word == "blur") return blur(image, value);
  if (word == "motion") return motion_blur(image, static_cast<int>(value));
  if (word == "noise") return noise(image, value, seed);
  if (word == "cover") return cover(image, value);
  if (word == "boxes") return boxes(image, value, seed);
  if (word == "drift") return gain(image, drifting_gain(seed));
  if (word == "jpeg") return jpeg_again(image, static_cast<int>(value));
  if (word == "flip") return upside_down(image);
  if (word == "fill") return filled(image, to_byte(value));
  return std::nullopt;
}

}  // namespace zonepack::test_support
