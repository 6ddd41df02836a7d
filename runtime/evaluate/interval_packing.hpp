// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace zonepack {

// A gain that holds `size` at every step from `first` to `last` (none when last < first).
struct Interval {
  std::size_t first = 0, last = 0;
  std::uint64_t size = 0;
  std::uint64_t gain = 0;
};

// No less than the largest gain of any set of intervals whose sizes, at no step, add up to more
// than what is free there: the optimum of the linear relaxation, in which intervals may be taken in
// part, rounded up by less than one.
//
// With f = the size taken of an interval, the relaxation is
//   max sum f gain / size,   0 <= f <= size,   at each step t: idle(t) + sum of f over t = free(t).
// Subtracting each step's equation from the next one's makes these the conservation of a flow along
// the steps, with free(t) - free(t - 1) entering before step t: each column then has one +1 and one
// -1. So it is a flow of least cost in a graph without circles, solved exactly by augmenting along
// shortest paths. Gains per size are rounded up to integers, so what is returned bounds from above.
//
// Invariant: gains add up to less than 2^50, and sizes and what is free to less than 2^40.
std::uint64_t most_gain(std::span<const std::uint64_t> free, std::span<const Interval> intervals);

}  // namespace zonepack
