// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "platform/base/byte_count.hpp"
#include "runtime/pack_format/file/transitions_bytes.hpp"
#include "runtime/pack_format/ids.hpp"
#include "runtime/pack_format/limits.hpp"
#include "runtime/zones/zone_graph.hpp"

namespace zonepack {

// A zone that may be entered next.
struct Successor {
  ZoneId zone = kNoZone;
  float share = 0;    // its probability; those of all successors add up to at most 1
  float seconds = 0;  // expected between entering the zone before it and entering this one
};

// The likeliest zones to be entered next: the likeliest first, then lowest ZoneId.
class Successors {
 public:
  static constexpr std::size_t kMost = kMostTransitionSuccessors;

  std::size_t size() const noexcept { return count_; }
  bool empty() const noexcept { return count_ == 0; }
  const Successor& operator[](std::size_t i) const noexcept { return all_[i]; }
  const Successor* begin() const noexcept { return all_.data(); }
  const Successor* end() const noexcept { return all_.data() + count_; }

  // Keeps the likeliest kMost.
  void add(const Successor& successor) noexcept;

 private:
  std::array<Successor, kMost> all_{};
  std::size_t count_ = 0;
};

// Whether a portal joins the two zones.
bool joined(const ZoneGraph& graph, ZoneId a, ZoneId b) noexcept;

// Which zone a robot enters next, as counted on its drives: by the zone that it is in and the one
// before it (order 2), blended with what is known of the zone that it is in alone (order 1), and
// that with the geometry of the portals: straight on rather than left or right, and that rather
// than back. The fewer the counts, the more weight the coarser one has:
//
//   share2 = (count2 + kBackOff * share1) / (all2 + kBackOff), and share1 likewise of geometry
//
// Counts fade: each drive through a context takes 1/64 of what it counted before, so habits that
// changed are unlearned. Order 2 with fallback after Song, Kotz, Jain and He, "Evaluating location
// predictors with extensive Wi-Fi mobility data" (INFOCOM 2004).
//
// The table is of fixed size: when it is full, the context that was not seen for longest goes.
//
// Memory: transitions_bytes() (pack_format/file/transitions_bytes.hpp), all of it from the start.
// Real-time: no allocation after construction, but for contexts(). after() costs the portals of one
// zone times at most kMostCandidates, and like learn() a look at the size of each context before
// the one it needs; learn() at most a move of the table besides.
// Threads: one at a time.
class Transitions {
 public:
  static constexpr std::size_t kMostContexts = kMostTransitionContexts;
  static constexpr std::uint32_t kOne = 1024;  // a count of one
  static constexpr std::uint32_t kFade = 64;
  static constexpr std::uint32_t kMostCount = kFade * kOne;
  static constexpr std::uint32_t kMostMilliseconds = 3'600'000;
  static constexpr std::uint32_t kOldest = (1u << 18) - 1;  // steps since a successor was counted

  struct Entry {
    ZoneId zone = kNoZone;  // a neighbour; kNoZone: none here, nor further on
    std::uint32_t count = 0;
    std::uint32_t milliseconds = 0;  // mean, from entering the zone before to entering this one
    std::uint32_t seen = 0;          // steps() when it was last counted; at most kOldest before now
  };
  struct Context {
    ZoneId before = kNoZone;  // kNoZone: of order 1
    ZoneId now = kNoZone;
    std::uint32_t seen = 0;
    std::array<Entry, Successors::kMost> next{};

    std::size_t size() const noexcept;
  };

  // The graph must outlive this object. One context for each zone, and one for each way through a
  // portal, but at most kMostContexts.
  explicit Transitions(const ZoneGraph& graph);

  // Counts that a robot which came from `before` (kNoZone: not known) left `now` for `next`, which
  // a portal joins, `stay_ns` after it entered. False, and nothing is counted, when no portal does.
  bool learn(ZoneId before, ZoneId now, ZoneId next, std::int64_t stay_ns) noexcept;

  // What comes after `now`, entered from `before` (kNoZone: not known). Empty for kNoZone.
  Successors after(ZoneId before, ZoneId now) const noexcept;

  // Expected seconds between entering `now` from `before` and leaving it.
  double seconds_in(ZoneId before, ZoneId now) const noexcept;

  // Takes over what another map's table holds of zones that have the same name in this map and are
  // joined likewise; what this one held goes. Looks each zone of a context up by its name.
  void take_over(const Transitions& other) noexcept;

  // Adds a context from a file. False, and nothing is added, when it is there already, does not fit
  // this map or the table, or breaks a rule.
  bool restore(const Context& context) noexcept;

  // All, ascending by zone before and zone; kNoZone comes last.
  std::vector<Context> contexts() const;
  std::uint32_t steps() const noexcept { return steps_; }  // counted so far, modulo 2^32
  void continue_steps(std::uint32_t steps) noexcept { steps_ = steps; }
  std::size_t capacity() const noexcept { return most_; }
  const ZoneGraph& graph() const noexcept { return graph_; }
  ByteCount memory_bytes() const noexcept;  // everything it allocated

 private:
  static constexpr std::size_t kMostCandidates = 4 * Successors::kMost;
  struct Candidates;

  // An entry in the table, which has no room for more bits.
  struct Packed {
    std::uint64_t
        exit : 8;  // the first that leads to the successor, of those of the context's zone
    std::uint64_t count_less_one : 16;
    std::uint64_t milliseconds : 22;
    std::uint64_t seen : 18;  // the last bits of steps()
  };
  static_assert(sizeof(Packed) == kTransitionSuccessorBytes);
  static_assert(kMaxPortalsPerZone <= 1u << 8 && kMostCount <= 1u << 16);
  static constexpr std::uint32_t kMillisecondBits = (1u << 22) - 1;
  static_assert(kMostMilliseconds <= kMillisecondBits);

  // Of a context in the table; `index` is the number of contexts where there is none.
  struct Place {
    std::size_t index = 0;
    std::size_t first = 0;  // of its successors
    std::size_t size = 0;
  };

  std::uint32_t way(ZoneId before, ZoneId now) const noexcept;
  std::uint8_t exit_to(ZoneId now, ZoneId next) const noexcept;
  Place at(std::size_t index) const noexcept;
  Place find(ZoneId before, ZoneId now) const noexcept;
  Place open(ZoneId before, ZoneId now) noexcept;
  void close(const Place& place) noexcept;
  void add(Place& place, const Packed& entry) noexcept;
  void count(ZoneId before, ZoneId now, ZoneId next, std::uint32_t milliseconds) noexcept;
  Packed pack(ZoneId now, const Entry& entry) const noexcept;
  Entry entry_of(ZoneId now, const Packed& packed) const noexcept;
  Context context(std::size_t index) const noexcept;
  void blend_in(ZoneId now, const Place& place, Candidates& all) const noexcept;
  void add_geometry(ZoneId before, ZoneId now, Candidates& all) const noexcept;

  const ZoneGraph& graph_;
  std::uint32_t exits_ = 0;  // of all zones
  std::size_t most_;
  // Of each context, ascending by way.
  std::vector<std::uint32_t> ways_;
  std::vector<std::uint32_t> seen_;
  std::vector<std::uint8_t> sizes_;
  std::vector<Packed> entries_;  // of all contexts, one after the other
  std::uint32_t steps_ = 0;
};

// Follows a robot from zone to zone: what Transitions learns from.
class ZoneSteps {
 public:
  // From `now`, which it had entered from `before` (kNoZone: not known), to its neighbour `next`.
  struct Step {
    ZoneId before = kNoZone, now = kNoZone, next = kNoZone;
    std::int64_t stay_ns = 0;
  };

  // The robot is in `zone` since t_ns; kNoZone: it is not known where. Null unless this completes a
  // step; the same zone again is none.
  const Step* enter(const ZoneGraph& graph, ZoneId zone, std::int64_t t_ns) noexcept;

  ZoneId before() const noexcept { return before_; }
  ZoneId now() const noexcept { return now_; }
  std::int64_t since_ns() const noexcept { return since_ns_; }

  // Goes on from a state that was saved.
  void go_on(ZoneId before, ZoneId now, std::int64_t since_ns) noexcept;

 private:
  ZoneId before_ = kNoZone;
  ZoneId now_ = kNoZone;
  std::int64_t since_ns_ = 0;
  Step step_;
};

}  // namespace zonepack
