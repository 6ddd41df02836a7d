// SPDX-License-Identifier: Apache-2.0
#include "runtime/evaluate/interval_packing.hpp"

#include <algorithm>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "platform/base/require.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kFar = std::numeric_limits<std::int64_t>::max() / 4;

// Flow of least cost from a source to a sink, by successive shortest paths with potentials.
class FlowNetwork {
 public:
  explicit FlowNetwork(std::size_t nodes) : out_(nodes), potential_(nodes, 0) {}

  void add(std::size_t from, std::size_t to, std::int64_t room, std::int64_t cost) {
    out_[from].push_back(arcs_.size());
    arcs_.push_back({to, room, cost});
    out_[to].push_back(arcs_.size());
    arcs_.push_back({from, 0, -cost});
  }

  // Arcs lead from lower nodes to higher ones, but for those of `source` and `sink`, which are the
  // last two. Returns the cost of the largest flow.
  std::int64_t run(std::size_t source, std::size_t sink) {
    begin(source, sink);
    std::int64_t cost = 0;
    while (reach(source, sink)) cost += augment(source, sink);
    return cost;
  }

 private:
  struct Arc {
    std::size_t to;
    std::int64_t room;
    std::int64_t cost;
  };

  // Distances over arcs of any sign, node by node: there is no circle yet.
  void begin(std::size_t source, std::size_t sink) {
    std::ranges::fill(potential_, kFar);
    potential_[source] = 0;
    const auto relax = [this](std::size_t node) {
      if (potential_[node] == kFar) return;
      for (const std::size_t a : out_[node]) {
        if (arcs_[a].room == 0) continue;
        std::int64_t& there = potential_[arcs_[a].to];
        there = std::min(there, potential_[node] + arcs_[a].cost);
      }
    };
    relax(source);
    for (std::size_t node = 0; node < source; ++node) relax(node);
    // Nobody can come here, now or later: flow leads on along arcs with room.
    for (std::int64_t& value : potential_) {
      if (value == kFar) value = 0;
    }
    (void)sink;
  }

  bool reach(std::size_t source, std::size_t sink) {
    distance_.assign(out_.size(), kFar);
    by_.assign(out_.size(), 0);
    using Entry = std::pair<std::int64_t, std::size_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> next;
    distance_[source] = 0;
    next.emplace(0, source);
    while (!next.empty()) {
      const auto [far, node] = next.top();
      next.pop();
      if (far > distance_[node]) continue;
      for (const std::size_t a : out_[node]) {
        const Arc& arc = arcs_[a];
        if (arc.room == 0) continue;
        const std::int64_t there = far + arc.cost + potential_[node] - potential_[arc.to];
        if (there >= distance_[arc.to]) continue;
        distance_[arc.to] = there;
        by_[arc.to] = a;
        next.emplace(there, arc.to);
      }
    }
    if (distance_[sink] == kFar) return false;
    for (std::size_t node = 0; node < out_.size(); ++node) {
      potential_[node] += std::min(distance_[node], distance_[sink]);
    }
    return true;
  }

  std::int64_t augment(std::size_t source, std::size_t sink) {
    std::int64_t room = kFar, cost = 0;
    for (std::size_t node = sink; node != source; node = arcs_[by_[node] ^ 1].to) {
      room = std::min(room, arcs_[by_[node]].room);
    }
    for (std::size_t node = sink; node != source; node = arcs_[by_[node] ^ 1].to) {
      arcs_[by_[node]].room -= room;
      arcs_[by_[node] ^ 1].room += room;
      cost += arcs_[by_[node]].cost * room;
    }
    return cost;
  }

  std::vector<Arc> arcs_;  // each is followed by its reverse
  std::vector<std::vector<std::size_t>> out_;
  std::vector<std::int64_t> potential_, distance_;
  std::vector<std::size_t> by_;  // the arc by which a node is reached
};

}  // namespace

std::uint64_t most_gain(std::span<const std::uint64_t> free, std::span<const Interval> intervals) {
  std::uint64_t all = 0, certain = 0;
  for (const Interval& interval : intervals) all += interval.gain;
  if (all == 0) return 0;
  // Gains are counted in 1 / scale; no path's cost, and no sum of costs, passes 2^62.
  std::uint64_t scale = 1;
  while (all * scale < (std::uint64_t{1} << 52)) scale *= 2;

  const std::size_t steps = free.size();
  const std::size_t source = steps + 1, sink = steps + 2;
  FlowNetwork network(steps + 3);
  std::int64_t wanted = 0;
  std::uint64_t before = 0;
  for (std::size_t t = 0; t <= steps; ++t) {  // node t stands before step t
    const std::uint64_t now = t < steps ? free[t] : 0;
    const auto in = static_cast<std::int64_t>(now) - static_cast<std::int64_t>(before);
    if (in > 0) network.add(source, t, in, 0);
    if (in < 0) network.add(t, sink, -in, 0);
    wanted += std::max<std::int64_t>(in, 0);
    if (t < steps) network.add(t, t + 1, kFar, 0);
    before = now;
  }
  for (const Interval& interval : intervals) {
    if (interval.gain == 0) continue;
    if (interval.size == 0 || interval.last < interval.first) {
      certain += interval.gain;
      continue;
    }
    ZP_REQUIRE(interval.last < steps);
    const std::uint64_t each = (interval.gain * scale + interval.size - 1) / interval.size;
    network.add(interval.first, interval.last + 1, static_cast<std::int64_t>(interval.size),
                -static_cast<std::int64_t>(each));
  }
  const std::int64_t cost = wanted == 0 ? 0 : network.run(source, sink);
  return certain + static_cast<std::uint64_t>(-cost) / scale;
}

}  // namespace zonepack
