// SPDX-License-Identifier: Apache-2.0
#include "runtime/zones/foresight.hpp"

#include <algorithm>

namespace zonepack {
namespace {

constexpr float kSoon_s = 5;          // sooner is not worth more
constexpr float kLeastShare = 0.03f;  // of a way that is followed on
constexpr float kLongest_s = 120;     // a way is followed so far
constexpr float kUnknownStay_s = 10;

// A way through the zones from the robot's: its last zone, and the node of the way before it.
struct Node {
  ZoneId before = kNoZone;
  ZoneId now = kNoZone;
  float share = 0;
  float seconds = 0;
  int parent = -1;
  bool open = true;
};

constexpr std::size_t kMostNodes = 96;

bool passed(const std::array<Node, kMostNodes>& nodes, int node, ZoneId zone) noexcept {
  for (; node >= 0; node = nodes[static_cast<std::size_t>(node)].parent) {
    if (nodes[static_cast<std::size_t>(node)].now == zone) return true;
  }
  return false;
}

}  // namespace

float Coming::worth() const noexcept { return share / std::max(seconds, kSoon_s); }

float Foresight::worth(ZoneId zone) const noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    if (all_[i].zone == zone) return all_[i].worth();
  }
  return 0;
}

void Foresight::add(ZoneId zone, float share, float seconds) noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    Coming& coming = all_[i];
    if (coming.zone != zone) continue;
    coming.seconds = (coming.seconds * coming.share + seconds * share) / (coming.share + share);
    coming.share += share;
    return;
  }
  if (count_ < all_.size()) all_[count_++] = {zone, share, seconds};
}

void Foresight::sort() noexcept {
  std::sort(all_.begin(), all_.begin() + static_cast<std::ptrdiff_t>(count_),
            [](const Coming& a, const Coming& b) {
              const float left = a.worth(), right = b.worth();
              return left != right ? left > right : a.zone < b.zone;
            });
}

void Foresight::look(const Transitions& transitions, ZoneId before, ZoneId now) noexcept {
  clear();
  if (now == kNoZone) return;
  std::array<Node, kMostNodes> nodes;
  nodes[0] = {before, now, 1, 0, -1, true};
  std::size_t count = 1;
  for (std::size_t looks = 0; looks < kMostLooks; ++looks) {
    std::size_t best = count;
    for (std::size_t i = 0; i < count; ++i) {
      if (nodes[i].open && (best == count || nodes[i].share > nodes[best].share)) best = i;
    }
    if (best == count) break;
    nodes[best].open = false;
    const Node from = nodes[best];
    for (const Successor& next : transitions.after(from.before, from.now)) {
      const float share = from.share * next.share;
      const float seconds = from.seconds + next.seconds;
      if (share < kLeastShare) continue;
      if (!passed(nodes, static_cast<int>(best), next.zone)) add(next.zone, share, seconds);
      if (count == nodes.size() || seconds > kLongest_s) continue;
      nodes[count++] = {from.now, next.zone, share, seconds, static_cast<int>(best), true};
    }
  }
  sort();
}

void Foresight::follow(std::span<const ZoneId> ahead, ZoneId before, ZoneId now,
                       const Transitions* transitions) noexcept {
  clear();
  float seconds = 0;
  for (const ZoneId zone : ahead) {
    float stay = kUnknownStay_s;
    if (transitions != nullptr) {
      for (const Successor& next : transitions->after(before, now)) {
        if (next.zone == zone) stay = next.seconds;
      }
    }
    seconds += stay;
    before = now;
    now = zone;
    const auto listed = coming();
    if (std::none_of(listed.begin(), listed.end(),
                     [zone](const Coming& coming) { return coming.zone == zone; })) {
      add(zone, 1, seconds);
    }
  }
}

}  // namespace zonepack
