// SPDX-License-Identifier: Apache-2.0
#include "runtime/zones/transitions.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "platform/base/require.hpp"
#include "runtime/pack_format/file/transitions_bytes.hpp"

namespace zonepack {

// What zonepack plan says.
static_assert(sizeof(Transitions::Context) == kTransitionContextBytes);
static_assert(Transitions::kMostContexts == kMostTransitionContexts);

namespace {

// Of a context: so many drives count as much as what the coarser one says.
constexpr double kBackOff = 0.5;

// Weights of a portal by where it leads: back where the robot came from, sideways, straight on.
constexpr double kBack = 0.25;
constexpr double kSideways = 1;
constexpr double kStraight = 3;

// Of a zone that was never left: how fast a robot crosses it, and at least this long.
constexpr double kCrossing_m_s = 0.5;
constexpr double kLeastStay_s = 1;

// A mean follows the last so many stays.
constexpr std::int64_t kMeanOf = 16;

Point2 middle(const Segment2& segment) noexcept {
  return {(segment.p.x_m + segment.q.x_m) / 2, (segment.p.y_m + segment.q.y_m) / 2};
}

auto key(const Transitions::Context& context) noexcept {
  return std::tuple(context.before, context.now);
}

bool likelier(const Successor& a, const Successor& b) noexcept {
  return a.share != b.share ? a.share > b.share : a.zone < b.zone;
}

}  // namespace

void Successors::add(const Successor& successor) noexcept {
  std::size_t place = count_;
  while (place > 0 && likelier(successor, all_[place - 1])) --place;
  if (place == kMost) return;
  const std::size_t last = std::min(count_, kMost - 1);
  for (std::size_t i = last; i > place; --i) all_[i] = all_[i - 1];
  all_[place] = successor;
  count_ = last + 1;
}

// Zones with their shares as far as they are blended.
struct Transitions::Candidates {
  struct One {
    ZoneId zone = kNoZone;
    double share = 0;
    double seconds = 0;
    bool timed = false;  // seconds were measured
  };
  std::array<One, kMostCandidates> all{};
  std::size_t count = 0;

  // Null when there is no room.
  One* of(ZoneId zone) noexcept {
    for (std::size_t i = 0; i < count; ++i) {
      if (all[i].zone == zone) return &all[i];
    }
    if (count == all.size()) return nullptr;
    all[count].zone = zone;
    return &all[count++];
  }
};

std::size_t Transitions::Context::size() const noexcept {
  std::size_t size = 0;
  while (size < next.size() && next[size].zone != kNoZone) ++size;
  return size;
}

std::size_t Transitions::capacity_for(std::size_t zones, std::size_t portals) noexcept {
  return std::min(kMostContexts, zones + 2 * portals);
}

Transitions::Transitions(const ZoneGraph& graph) : graph_(graph) {
  std::size_t ways = 0;
  for (ZoneId zone = 0; zone < graph.zone_count(); ++zone) ways += graph.exits(zone).size();
  most_ = capacity_for(graph.zone_count(), ways / 2);
  contexts_.reserve(most_);
}

bool joined(const ZoneGraph& graph, ZoneId a, ZoneId b) noexcept {
  if (a >= graph.zone_count() || b >= graph.zone_count()) return false;
  const auto exits = graph.exits(a);
  return std::any_of(exits.begin(), exits.end(), [b](const Exit& exit) { return exit.to == b; });
}

const Transitions::Context* Transitions::find(ZoneId before, ZoneId now) const noexcept {
  const auto place = std::ranges::lower_bound(contexts_, std::tuple(before, now), {}, key);
  if (place == contexts_.end() || place->before != before || place->now != now) return nullptr;
  return &*place;
}

Transitions::Context& Transitions::open(ZoneId before, ZoneId now) noexcept {
  if (const Context* const found = find(before, now)) return const_cast<Context&>(*found);
  ZP_REQUIRE(most_ > 0);
  if (contexts_.size() == most_) {
    // The farthest back, however often the count of steps has wrapped around.
    const auto oldest = std::ranges::max_element(
        contexts_, {}, [this](const Context& context) { return steps_ - context.seen; });
    contexts_.erase(oldest);
  }
  const auto place = std::ranges::lower_bound(contexts_, std::tuple(before, now), {}, key);
  Context context;
  context.before = before;
  context.now = now;
  return *contexts_.insert(place, context);
}

void Transitions::count(Context& context, ZoneId next, std::uint32_t milliseconds) noexcept {
  context.seen = steps_;
  for (Entry& entry : context.next) entry.count -= entry.count / kFade;
  const std::size_t size = context.size();
  const auto end = context.next.begin() + static_cast<std::ptrdiff_t>(size);
  auto place = std::find_if(context.next.begin(), end,
                            [&](const Entry& entry) { return entry.zone == next; });
  if (place == end) {
    if (size == context.next.size()) {
      // The rarest makes room, of several the one not seen for longest.
      place = std::min_element(context.next.begin(), end, [this](const Entry& a, const Entry& b) {
        return a.count != b.count ? a.count < b.count : steps_ - a.seen > steps_ - b.seen;
      });
    }
    *place = {next, 0, milliseconds, 0};
  }
  const std::int64_t stays =
      std::clamp<std::int64_t>((place->count + kOne / 2) / kOne + 1, 1, kMeanOf);
  const std::int64_t off = std::int64_t{milliseconds} - place->milliseconds;
  place->milliseconds = static_cast<std::uint32_t>(place->milliseconds + off / stays);
  place->count = std::min(place->count + kOne, kMostCount);
  place->seen = steps_;
}

bool Transitions::learn(ZoneId before, ZoneId now, ZoneId next, std::int64_t stay_ns) noexcept {
  if (!joined(graph_, now, next)) return false;
  const auto milliseconds = static_cast<std::uint32_t>(
      std::clamp<std::int64_t>(stay_ns / 1'000'000, 0, kMostMilliseconds));
  ++steps_;
  count(open(kNoZone, now), next, milliseconds);
  if (joined(graph_, before, now)) count(open(before, now), next, milliseconds);
  return true;
}

void Transitions::add_geometry(ZoneId before, ZoneId now, Candidates& all) const noexcept {
  const std::span<const Exit> exits = graph_.exits(now);
  const auto entry = std::find_if(exits.begin(), exits.end(),
                                  [before](const Exit& exit) { return exit.to == before; });
  const bool known = entry != exits.end();
  const Point2 from = known ? middle(entry->segment) : Point2{};
  double sum = 0;
  for (int pass = 0; pass < 2; ++pass) {
    for (const Exit& exit : exits) {
      const Point2 to = middle(exit.segment);
      const double x_m = to.x_m - from.x_m, y_m = to.y_m - from.y_m;
      const double way_m = known ? std::sqrt(x_m * x_m + y_m * y_m) : 0;
      double weight = kSideways;
      if (exit.to == before) {
        weight = kBack;
      } else if (way_m > 0) {
        const double ahead = -(x_m * entry->outward.x_m + y_m * entry->outward.y_m) / way_m;
        weight += (kStraight - kSideways) * std::max(ahead, 0.0);
      }
      if (pass == 0) {
        sum += weight;
      } else if (Candidates::One* const one = all.of(exit.to)) {
        one->share += weight / sum;
        if (!one->timed) one->seconds = std::max(kLeastStay_s, way_m / kCrossing_m_s);
      }
    }
  }
}

void Transitions::blend_in(const Context* context, Candidates& all) const noexcept {
  if (context == nullptr) return;
  double sum = kBackOff;
  for (const Entry& entry : context->next) sum += static_cast<double>(entry.count) / kOne;
  for (std::size_t i = 0; i < all.count; ++i) all.all[i].share *= kBackOff / sum;
  for (const Entry& entry : context->next) {
    if (entry.zone == kNoZone) break;
    Candidates::One* const one = all.of(entry.zone);
    if (one == nullptr) continue;
    one->share += static_cast<double>(entry.count) / kOne / sum;
    one->seconds = static_cast<double>(entry.milliseconds) / 1000;
    one->timed = true;
  }
}

Successors Transitions::after(ZoneId before, ZoneId now) const noexcept {
  Successors successors;
  if (now >= graph_.zone_count()) return successors;
  const Context* const order2 = joined(graph_, before, now) ? find(before, now) : nullptr;
  const Context* const order1 = find(kNoZone, now);
  Candidates all;
  // What was counted first, so that it has room whatever the number of portals.
  for (const Context* const context : {order2, order1}) {
    if (context == nullptr) continue;
    for (const Entry& entry : context->next) {
      if (entry.zone != kNoZone) all.of(entry.zone);
    }
  }
  add_geometry(before, now, all);
  blend_in(order1, all);
  blend_in(order2, all);
  for (std::size_t i = 0; i < all.count; ++i) {
    const Candidates::One& one = all.all[i];
    successors.add({one.zone, static_cast<float>(one.share), static_cast<float>(one.seconds)});
  }
  return successors;
}

double Transitions::seconds_in(ZoneId before, ZoneId now) const noexcept {
  double share = 0, seconds = 0;
  for (const Successor& next : after(before, now)) {
    share += static_cast<double>(next.share);
    seconds += static_cast<double>(next.share) * static_cast<double>(next.seconds);
  }
  return share > 0 ? seconds / share : 0;
}

bool Transitions::restore(const Context& context) noexcept {
  if (contexts_.size() == most_ || find(context.before, context.now) != nullptr) return false;
  if (context.now >= graph_.zone_count()) return false;
  if (context.before != kNoZone && !joined(graph_, context.before, context.now)) return false;
  const std::size_t size = context.size();
  if (size == 0) return false;
  for (std::size_t i = 0; i < size; ++i) {
    const Entry& entry = context.next[i];
    if (!joined(graph_, context.now, entry.zone) || entry.count == 0 || entry.count > kMostCount ||
        entry.milliseconds > kMostMilliseconds)
      return false;
    for (std::size_t k = 0; k < i; ++k) {
      if (context.next[k].zone == entry.zone) return false;
    }
  }
  Context& added = open(context.before, context.now);
  added.seen = context.seen;
  std::copy_n(context.next.begin(), size, added.next.begin());
  return true;
}

void Transitions::take_over(const Transitions& other) noexcept {
  contexts_.clear();
  steps_ = other.steps_;
  const auto here = [&](ZoneId zone) {
    return zone == kNoZone ? kNoZone : graph_.find(other.graph_.name(zone));
  };
  for (const Context& theirs : other.contexts_) {
    Context context;
    context.before = here(theirs.before);
    context.now = here(theirs.now);
    context.seen = theirs.seen;
    // A zone before that is gone leaves nothing that order 1 does not hold.
    if (context.before == kNoZone && theirs.before != kNoZone) continue;
    std::size_t size = 0;
    for (const Entry& entry : theirs.next) {
      const ZoneId zone = here(entry.zone);
      if (!joined(graph_, context.now, zone)) continue;
      context.next[size] = entry;
      context.next[size++].zone = zone;
    }
    restore(context);
  }
}

const ZoneSteps::Step* ZoneSteps::enter(const ZoneGraph& graph, ZoneId zone,
                                        std::int64_t t_ns) noexcept {
  if (zone == now_) return nullptr;
  const bool step = joined(graph, now_, zone);
  step_ = {before_, now_, zone, t_ns - since_ns_};
  before_ = step ? now_ : kNoZone;
  now_ = zone;
  since_ns_ = t_ns;
  return step ? &step_ : nullptr;
}

void ZoneSteps::go_on(ZoneId before, ZoneId now, std::int64_t since_ns) noexcept {
  before_ = before;
  now_ = now;
  since_ns_ = since_ns;
}

}  // namespace zonepack
