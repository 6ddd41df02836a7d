// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "runtime/pack_format/file/geometry.hpp"

namespace zonepack::packer {

inline Box2 box_of(const Segment2& s) noexcept {
  return {{std::min(s.p.x_m, s.q.x_m), std::min(s.p.y_m, s.q.y_m)},
          {std::max(s.p.x_m, s.q.x_m), std::max(s.p.y_m, s.q.y_m)}};
}

// Things with a lowest and a highest coordinate, found by the stretch they touch. Costs one step
// for each thing that may touch it, so few where all are short.
class Stretches {
 public:
  void reserve(std::size_t count) { sorted_.reserve(count); }
  void add(double low, double high) {
    sorted_.push_back({low, high, static_cast<std::uint32_t>(sorted_.size())});
    longest_ = std::max(longest_, high - low);
  }
  // Call once after the last add().
  void sort() {
    std::sort(sorted_.begin(), sorted_.end(),
              [](const Stretch& a, const Stretch& b) { return a.low < b.low; });
  }

  // The places, in the order of add(), of all that touch [low, high]; valid until the next call.
  // `looked_at` counts what had to be compared.
  const std::vector<std::uint32_t>& touching(double low, double high, std::uint64_t& looked_at) {
    found_.clear();
    auto at = std::lower_bound(sorted_.begin(), sorted_.end(), low - longest_,
                               [](const Stretch& s, double from) { return s.low < from; });
    for (; at != sorted_.end() && at->low <= high; ++at) {
      ++looked_at;
      if (at->high >= low) found_.push_back(at->place);
    }
    std::sort(found_.begin(), found_.end());
    return found_;
  }

 private:
  struct Stretch {
    double low, high;
    std::uint32_t place;
  };
  std::vector<Stretch> sorted_;
  std::vector<std::uint32_t> found_;
  double longest_ = 0;
};

inline Stretches rows_of(const std::vector<Segment2>& edges) {
  Stretches rows;
  rows.reserve(edges.size());
  for (const Segment2& e : edges) {
    rows.add(std::min(e.p.y_m, e.q.y_m), std::max(e.p.y_m, e.q.y_m));
  }
  rows.sort();
  return rows;
}

}  // namespace zonepack::packer
