// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/cloud/cloud_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace zonepack::packer {
namespace {

// Spreads the low 10 bits of a number to every third bit.
std::uint32_t spread_bits(std::uint32_t v) {
  v = (v | v << 16) & 0x030000FFU;
  v = (v | v << 8) & 0x0300F00FU;
  v = (v | v << 4) & 0x030C30C3U;
  return (v | v << 2) & 0x09249249U;
}

// The step of a coordinate, of 1024 between the least and the most of it.
std::vector<std::uint32_t> steps_of(const std::vector<float>& values, float cell) {
  const float least = *std::ranges::min_element(values);
  std::vector<std::uint32_t> steps;
  steps.reserve(values.size());
  for (const float v : values) {
    steps.push_back(static_cast<std::uint32_t>(std::clamp((v - least) / cell, 0.0F, 1023.0F)));
  }
  return steps;
}

float extent_of(const std::vector<float>& values) {
  const auto [least, most] = std::ranges::minmax_element(values);
  return *most - *least;
}

template <typename T>
void permute(std::vector<T>& values, const std::vector<std::uint32_t>& order) {
  if (values.empty()) return;
  std::vector<T> sorted;
  sorted.reserve(values.size());
  for (const std::uint32_t i : order) sorted.push_back(values[i]);
  values = std::move(sorted);
}

}  // namespace

void TilePoints::clear() {
  for (auto* column : {&x, &y, &z, &intensity, &ring}) column->clear();
  rgb.clear();
}

bool is_place(const CloudPoint& p) {
  constexpr double kFurthest_m = 1e7;
  return std::abs(p.x) < kFurthest_m && std::abs(p.y) < kFurthest_m && std::abs(p.z) < kFurthest_m;
}

void read_points(PointStream& stream, const std::array<double, 3>& origin, TilePoints& into) {
  into.clear();
  const CloudFields& fields = stream.fields();
  for (CloudPoint p; stream.next(p);) {
    if (!is_place(p)) continue;
    into.x.push_back(static_cast<float>(p.x - origin[0]));
    into.y.push_back(static_cast<float>(p.y - origin[1]));
    into.z.push_back(static_cast<float>(p.z - origin[2]));
    if (fields.intensity) into.intensity.push_back(p.intensity);
    if (fields.ring) into.ring.push_back(p.ring);
    if (fields.rgb) into.rgb.push_back(p.rgb);
  }
}

void sort_along_curve(TilePoints& points) {
  if (points.size() < 2) return;
  const float extent = std::max({extent_of(points.x), extent_of(points.y), extent_of(points.z)});
  const float cell = std::max(extent / 1023, std::numeric_limits<float>::min());
  const auto x = steps_of(points.x, cell), y = steps_of(points.y, cell),
             z = steps_of(points.z, cell);
  std::vector<std::uint32_t> codes(points.size()), order(points.size());
  for (std::size_t i = 0; i < codes.size(); ++i) {
    codes[i] = spread_bits(x[i]) | spread_bits(y[i]) << 1 | spread_bits(z[i]) << 2;
  }
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(order, {}, [&codes](std::uint32_t i) { return codes[i]; });
  permute(points.x, order);
  permute(points.y, order);
  permute(points.z, order);
  permute(points.intensity, order);
  permute(points.ring, order);
  permute(points.rgb, order);
}

}  // namespace zonepack::packer
