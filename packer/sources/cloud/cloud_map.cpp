// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/cloud/cloud_map.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "runtime/pack_format/column.hpp"

namespace zonepack::packer {
namespace {

// Coordinates in the form in which columns keep them.
using Ordered = std::array<std::vector<std::uint32_t>, 3>;

std::vector<std::uint32_t> ordered(const std::vector<float>& values) {
  std::vector<std::uint32_t> forms;
  forms.reserve(values.size());
  for (const float v : values) forms.push_back(ordered_from_float(std::bit_cast<std::uint32_t>(v)));
  return forms;
}

// Halves the points across their longest side, down to blocks.
void part(const Ordered& places, std::span<std::uint32_t> points) {
  while (points.size() > kBlockRows) {
    const std::vector<std::uint32_t>* longest = nullptr;
    std::uint32_t most = 0;
    for (const std::vector<std::uint32_t>& axis : places) {
      const auto [least, last] =
          std::ranges::minmax(points, {}, [&axis](std::uint32_t i) { return axis[i]; });
      if (longest == nullptr || axis[last] - axis[least] > most) {
        longest = &axis;
        most = axis[last] - axis[least];
      }
    }
    const std::size_t half = (points.size() + kBlockRows - 1) / kBlockRows / 2 * kBlockRows;
    std::ranges::nth_element(points, points.begin() + static_cast<std::ptrdiff_t>(half), {},
                             [&](std::uint32_t i) { return std::pair((*longest)[i], i); });
    part(places, points.first(half));
    points = points.subspan(half);
  }
  std::ranges::sort(points);
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

void sort_in_blocks(TilePoints& points) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  part({ordered(points.x), ordered(points.y), ordered(points.z)}, order);
  permute(points.x, order);
  permute(points.y, order);
  permute(points.z, order);
  permute(points.intensity, order);
  permute(points.ring, order);
  permute(points.rgb, order);
}

}  // namespace zonepack::packer
