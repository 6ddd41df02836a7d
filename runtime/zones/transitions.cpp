// SPDX-License-Identifier: Apache-2.0
#include "runtime/zones/transitions.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "platform/base/require.hpp"

namespace zonepack {

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

// A stay's new mean, when it is the `number`th.
std::uint32_t mean_of(std::uint32_t mean, std::uint32_t milliseconds,
                      std::int64_t number) noexcept {
  const std::int64_t off = std::int64_t{milliseconds} - mean;
  return static_cast<std::uint32_t>(mean + off / number);
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

Transitions::Transitions(const ZoneGraph& graph)
    : graph_(graph), exits_(graph.first_exit(static_cast<ZoneId>(graph.zone_count()))) {
  TransitionRoom room;
  for (ZoneId zone = 0; zone < graph.zone_count(); ++zone) room.add(graph.exits(zone).size());
  most_ = static_cast<std::size_t>(room.contexts());
  ways_.reserve(most_);
  seen_.reserve(most_);
  sizes_.reserve(most_);
  entries_.reserve(static_cast<std::size_t>(room.successors()));
}

ByteCount Transitions::memory_bytes() const noexcept {
  return ways_.capacity() * sizeof(ways_[0]) + seen_.capacity() * sizeof(seen_[0]) +
         sizes_.capacity() * sizeof(sizes_[0]) + entries_.capacity() * sizeof(entries_[0]);
}

bool joined(const ZoneGraph& graph, ZoneId a, ZoneId b) noexcept {
  if (a >= graph.zone_count() || b >= graph.zone_count()) return false;
  const auto exits = graph.exits(a);
  return std::any_of(exits.begin(), exits.end(), [b](const Exit& exit) { return exit.to == b; });
}

// The key of a context: the number of the first exit of `now` that leads back to `before`. Those of
// order 1 have `now`, counted on after the exits.
std::uint32_t Transitions::way(ZoneId before, ZoneId now) const noexcept {
  return before == kNoZone ? exits_ + now : graph_.first_exit(now) + exit_to(now, before);
}

std::uint8_t Transitions::exit_to(ZoneId now, ZoneId next) const noexcept {
  const std::span<const Exit> exits = graph_.exits(now);
  const auto place = std::ranges::find(exits, next, &Exit::to);
  ZP_REQUIRE(place != exits.end());
  return static_cast<std::uint8_t>(place - exits.begin());
}

Transitions::Place Transitions::at(std::size_t index) const noexcept {
  Place place{.index = index};
  for (std::size_t i = 0; i < index; ++i) place.first += sizes_[i];
  if (index < sizes_.size()) place.size = sizes_[index];
  return place;
}

Transitions::Place Transitions::find(ZoneId before, ZoneId now) const noexcept {
  const std::uint32_t wanted = way(before, now);
  const auto place = std::ranges::lower_bound(ways_, wanted);
  if (place == ways_.end() || *place != wanted) return {.index = ways_.size()};
  return at(static_cast<std::size_t>(place - ways_.begin()));
}

Transitions::Place Transitions::open(ZoneId before, ZoneId now) noexcept {
  if (const Place place = find(before, now); place.index < ways_.size()) return place;
  ZP_REQUIRE(most_ > 0);
  if (ways_.size() == most_) {
    // The farthest back, however often the count of steps has wrapped around.
    const auto oldest =
        std::ranges::max_element(seen_, {}, [this](std::uint32_t seen) { return steps_ - seen; });
    close(at(static_cast<std::size_t>(oldest - seen_.begin())));
  }
  const std::uint32_t wanted = way(before, now);
  const auto index = std::ranges::lower_bound(ways_, wanted) - ways_.begin();
  ways_.insert(ways_.begin() + index, wanted);
  seen_.insert(seen_.begin() + index, steps_);
  sizes_.insert(sizes_.begin() + index, 0);
  return at(static_cast<std::size_t>(index));
}

void Transitions::close(const Place& place) noexcept {
  const auto index = static_cast<std::ptrdiff_t>(place.index);
  const auto first = entries_.begin() + static_cast<std::ptrdiff_t>(place.first);
  entries_.erase(first, first + static_cast<std::ptrdiff_t>(place.size));
  ways_.erase(ways_.begin() + index);
  seen_.erase(seen_.begin() + index);
  sizes_.erase(sizes_.begin() + index);
}

void Transitions::add(Place& place, const Packed& entry) noexcept {
  ZP_REQUIRE(entries_.size() < entries_.capacity());
  entries_.insert(entries_.begin() + static_cast<std::ptrdiff_t>(place.first + place.size), entry);
  ++sizes_[place.index];
  ++place.size;
}

Transitions::Packed Transitions::pack(ZoneId now, const Entry& entry) const noexcept {
  const std::uint32_t age = std::min(steps_ - entry.seen, kOldest);
  return {.exit = exit_to(now, entry.zone),
          .count_less_one = (entry.count - 1) & (kMostCount - 1),
          .milliseconds = entry.milliseconds & kMillisecondBits,
          .seen = (steps_ - age) & kOldest};
}

Transitions::Entry Transitions::entry_of(ZoneId now, const Packed& packed) const noexcept {
  const std::uint32_t age = (steps_ - static_cast<std::uint32_t>(packed.seen)) & kOldest;
  return {.zone = graph_.exits(now)[packed.exit].to,
          .count = static_cast<std::uint32_t>(packed.count_less_one) + 1,
          .milliseconds = static_cast<std::uint32_t>(packed.milliseconds),
          .seen = steps_ - age};
}

Transitions::Context Transitions::context(std::size_t index) const noexcept {
  const Place place = at(index);
  const std::uint32_t way = ways_[index];
  Context context;
  context.seen = seen_[index];
  if (way < exits_) {
    context.now = graph_.zone_of_exit(way);
    context.before = graph_.exits(context.now)[way - graph_.first_exit(context.now)].to;
  } else {
    context.now = way - exits_;
  }
  for (std::size_t i = 0; i < place.size; ++i) {
    context.next[i] = entry_of(context.now, entries_[place.first + i]);
  }
  return context;
}

std::vector<Transitions::Context> Transitions::contexts() const {
  std::vector<Context> all;
  all.reserve(ways_.size());
  for (std::size_t i = 0; i < ways_.size(); ++i) all.push_back(context(i));
  std::ranges::sort(all, {}, key);
  return all;
}

void Transitions::count(ZoneId before, ZoneId now, ZoneId next,
                        std::uint32_t milliseconds) noexcept {
  Place place = open(before, now);
  seen_[place.index] = steps_;
  const auto entries = std::span(entries_).subspan(place.first, place.size);
  std::size_t found = place.size;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    Entry entry = entry_of(now, entries[i]);
    entry.count -= entry.count / kFade;
    entries[i] = pack(now, entry);
    if (entry.zone == next) found = i;
  }
  Entry counted{next, 0, milliseconds, 0};
  if (found < place.size) {
    counted = entry_of(now, entries[found]);
  } else if (place.size == Successors::kMost) {
    // The rarest makes room, of several the one not seen for longest.
    const auto rarest = std::ranges::min_element(entries, [&](const Packed& a, const Packed& b) {
      const Entry x = entry_of(now, a), y = entry_of(now, b);
      return x.count != y.count ? x.count < y.count : steps_ - x.seen > steps_ - y.seen;
    });
    found = static_cast<std::size_t>(rarest - entries.begin());
  }
  const std::int64_t number =
      std::clamp<std::int64_t>((counted.count + kOne / 2) / kOne + 1, 1, kMeanOf);
  counted.milliseconds = mean_of(counted.milliseconds, milliseconds, number);
  counted.count = std::min(counted.count + kOne, kMostCount);
  counted.seen = steps_;
  const Packed packed = pack(now, counted);
  if (found < place.size) {
    entries_[place.first + found] = packed;
  } else {
    add(place, packed);
  }
}

bool Transitions::learn(ZoneId before, ZoneId now, ZoneId next, std::int64_t stay_ns) noexcept {
  if (!joined(graph_, now, next)) return false;
  const auto milliseconds = static_cast<std::uint32_t>(
      std::clamp<std::int64_t>(stay_ns / 1'000'000, 0, kMostMilliseconds));
  ++steps_;
  count(kNoZone, now, next, milliseconds);
  if (joined(graph_, before, now)) count(before, now, next, milliseconds);
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

void Transitions::blend_in(ZoneId now, const Place& place, Candidates& all) const noexcept {
  if (place.size == 0) return;
  double sum = kBackOff;
  for (std::size_t i = 0; i < place.size; ++i) {
    sum += static_cast<double>(entry_of(now, entries_[place.first + i]).count) / kOne;
  }
  for (std::size_t i = 0; i < all.count; ++i) all.all[i].share *= kBackOff / sum;
  for (std::size_t i = 0; i < place.size; ++i) {
    const Entry entry = entry_of(now, entries_[place.first + i]);
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
  const Place order2 = joined(graph_, before, now) ? find(before, now) : Place{};
  const Place order1 = find(kNoZone, now);
  Candidates all;
  // What was counted first, so that it has room whatever the number of portals.
  for (const Place& place : {order2, order1}) {
    for (std::size_t i = 0; i < place.size; ++i) {
      all.of(entry_of(now, entries_[place.first + i]).zone);
    }
  }
  add_geometry(before, now, all);
  blend_in(now, order1, all);
  blend_in(now, order2, all);
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
  if (ways_.size() == most_ || context.now >= graph_.zone_count()) return false;
  if (context.before != kNoZone && !joined(graph_, context.before, context.now)) return false;
  if (find(context.before, context.now).index < ways_.size()) return false;
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
  Place added = open(context.before, context.now);
  seen_[added.index] = context.seen;
  for (std::size_t i = 0; i < size; ++i) add(added, pack(context.now, context.next[i]));
  return true;
}

void Transitions::take_over(const Transitions& other) noexcept {
  ways_.clear();
  seen_.clear();
  sizes_.clear();
  entries_.clear();
  steps_ = other.steps_;
  const auto here = [&](ZoneId zone) {
    return zone == kNoZone ? kNoZone : graph_.find(other.graph_.name(zone));
  };
  for (std::size_t i = 0; i < other.ways_.size(); ++i) {
    const Context theirs = other.context(i);
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
