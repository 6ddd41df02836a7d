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

inline GreyImage upside_down(GreyImage image) {
  std::reverse(image.pixels.begin(), image.pixels.end());
  return image;
}

inline GreyImage filled(GreyImage image, std::uint8_t value) {
  std::fill(image.pixels.begin(), image.pixels.end(), value);
  return image;
}

// "gain:2.5", "gamma:2", "blur:3", "motion:9", "noise:10", "cover:0.3", "flip", "fill:0"; none for
// another word.
inline std::optional<GreyImage> changed(const GreyImage& image, const std::string& change,
                                        std::uint32_t seed = 1) {
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
  if (word == "flip") return upside_down(image);
  if (word == "fill") return filled(image, to_byte(value));
  return std::nullopt;
}

}  // namespace zonepack::test_support
