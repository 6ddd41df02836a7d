// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/slabs.hpp"

#include <cmath>
#include <cstddef>

namespace zonepack::packer {
namespace {

constexpr double kUneven = 0.15;
constexpr double kLeastGap_m = 1e-6;  // wide enough to cut in

// Weights at one place.
struct Group {
  double first_m = 0, last_m = 0;
  ByteCount before = 0;  // weight of all groups before this one
};

std::vector<Group> grouped(std::span<const Weight> weights, double one_place_m, ByteCount& total) {
  std::vector<Group> groups;
  total = 0;
  for (const Weight& weight : weights) {
    if (groups.empty() || (weight.place_m - groups.back().first_m >= one_place_m &&
                           weight.place_m - groups.back().last_m >= kLeastGap_m)) {
      groups.push_back({weight.place_m, weight.place_m, total});
    }
    groups.back().last_m = weight.place_m;
    total += weight.bytes;
  }
  return groups;
}

}  // namespace

std::vector<Gap> choose_cuts(std::span<const Weight> weights, ByteCount limit, double one_place_m) {
  ByteCount total = 0;
  const std::vector<Group> groups = grouped(weights, one_place_m, total);
  const std::size_t count = groups.size();
  const auto before = [&](std::size_t i) { return i < count ? groups[i].before : total; };

  // end[i]: where a slab that begins with group i must end; slabs[i]: the fewest slabs from there
  // on.
  std::vector<std::size_t> end(count + 1, count), slabs(count + 1, 0);
  for (std::size_t i = count, j = count; i-- > 0;) {
    while (j > i + 1 && before(j) - before(i) > limit) --j;
    end[i] = j;
    slabs[i] = 1 + slabs[j];
  }

  std::vector<Gap> cuts;
  for (std::size_t start = 0; start < count && slabs[start] > 1;) {
    const std::size_t left = slabs[start];
    const double mean = static_cast<double>(total - before(start)) / static_cast<double>(left);
    std::size_t best = end[start];
    double best_off = 0, best_gap = 0;
    for (std::size_t j = end[start]; j > start && slabs[j] < left; --j) {
      const double off = std::abs(static_cast<double>(before(j) - before(start)) - mean);
      const double gap = groups[j].first_m - groups[j - 1].last_m;
      const bool even = off <= kUneven * mean, best_even = best_off <= kUneven * mean;
      const bool better = even && best_even ? gap > best_gap : off < best_off;
      if (j == end[start] || better) {
        best = j;
        best_off = off;
        best_gap = gap;
      }
    }
    cuts.push_back({groups[best - 1].last_m, groups[best].first_m});
    start = best;
  }
  return cuts;
}

}  // namespace zonepack::packer
