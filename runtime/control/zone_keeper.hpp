// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/control/event.hpp"
#include "runtime/control/zone_loader.hpp"
#include "runtime/memory/residency.hpp"
#include "runtime/memory/zone_directory.hpp"
#include "runtime/zones/foresight.hpp"

namespace zonepack {

struct ZoneKeeperSettings {
  // A zone that failed to load is tried again after this, doubled with every further failure.
  std::int64_t first_retry_ns = 1'000'000'000;
  std::int64_t last_retry_ns = 60'000'000'000;
};

// Keeps the wanted zones in memory: the most urgent first, never more than fits.
//
// One load is under way at a time, so that the storage works for the zone needed soonest. A load
// that is no longer wanted is cancelled; so is one that keeps the robot's own zone waiting. A
// wanted zone that does not fit takes the room of less urgent ones; if that is not enough, it
// waits, and blocked() says so. A zone that cannot be loaded affects no other.
//
// Real-time: no allocation after construction; a cycle costs O(kMaxWanted^2 + pins) plus one
// admission.
// Threads: owned by the control thread.
class ZoneKeeper {
 public:
  static constexpr std::size_t kMaxWanted = 16;
  static constexpr std::size_t kMostColder = 64;  // looked at for the room of a likely zone
  static constexpr std::size_t kMostPins = 64;    // besides those given at the start

  // needs: of every zone, by ZoneId. The pinned zones must have been accepted by Residency::pin().
  // directory: updated with which zones can be read; may be null. References and spans must outlive
  // this object; `pinned` is copied.
  ZoneKeeper(Residency& memory, ZoneLoader& loader, EventStamper& events,
             std::span<const ZoneNeed> needs, std::span<const ZoneId> pinned,
             ZoneDirectory* directory = nullptr, const ZoneKeeperSettings& settings = {});

  // Takes the loader's results; call once a cycle, before keep().
  void collect(std::int64_t now_ns, std::span<const LoadResult> loads) noexcept;

  // Keeps a zone in memory from the next keep() on, until unpin(). kNoRoom when the pins and the
  // largest pair of neighbours would not fit together, or there are too many.
  Result<void> pin(ZoneId zone) noexcept;
  void unpin(ZoneId zone) noexcept;

  // What is wanted in a cycle.
  struct Wishes {
    std::span<const ZoneId> zones{};  // most urgent first, no zone twice, at most kMaxWanted
    std::size_t urgent = 0;           // those after the first so many are only possible,
    std::size_t needed = 0;  // those after these only useful: they take what room there is and
                             // block nothing,
    std::size_t useful = 0;  // and those after these only likely: they take free room, and that of
                             // zones that foresight says are worth less
    bool with_own = true;    // the first is the robot's own zone
    const Foresight* foresight = nullptr;  // needed for likely ones
    bool sure = false;  // likely ones are the way ahead, in its order: none is loaded before one
                        // that comes sooner, and only the robot's own zone breaks a load off
    std::size_t due = kMaxWanted;  // likely ones after these take free room only
  };
  void keep(std::int64_t now_ns, const Wishes& wishes) noexcept;
  void keep(std::int64_t now_ns, std::span<const ZoneId> wanted, std::size_t urgent,
            std::size_t needed, bool with_own = true) noexcept {
    keep(now_ns, {wanted, urgent, needed, wanted.size(), with_own});
  }
  void keep(std::int64_t now_ns, std::span<const ZoneId> wanted, std::size_t urgent) noexcept {
    keep(now_ns, wanted, urgent, wanted.size());
  }

  // While held, no load starts; one under way finishes.
  void hold(bool held) noexcept { held_ = held; }
  bool loading() const noexcept { return loading_ != kNoZone; }

  // Evicts a resident zone, even a wanted one; false when it is not resident.
  bool drop(ZoneId zone) noexcept;

  // Adopts a zone that another map's keeper had loaded for this one: admits and completes it.
  // Before the first keep().
  void take_over(ZoneId zone, const SlotChain& slots) noexcept;

  // Gives a resident zone to another map's keeper, which adopts it: nothing is read again. Both
  // between two cycles; the zone's slots are in no keeper's hands until then.
  SlotChain hand_over(ZoneId zone) noexcept;
  void adopt(ZoneId zone, const SlotChain& slots) noexcept;

  // A wanted zone did not fit in the last cycle.
  bool blocked() const noexcept { return blocked_ != kNoZone; }

  // What this object's tables take from the budget.
  static ByteCount table_bytes(std::size_t zones) noexcept { return zones * sizeof(Retry); }

 private:
  struct Retry {
    std::int64_t not_before_ns = 0;
    std::uint32_t failures = 0;
  };

  bool wants(std::span<const ZoneId> list, ZoneId zone) const noexcept;
  void drop_unwanted(std::span<const ZoneId> wanted, std::size_t needed) noexcept;
  enum class Demand : std::uint8_t { kLikely, kUseful, kPossible, kUrgent, kOwn };
  static Demand demand_of(std::size_t place, const Wishes& wishes) noexcept;
  void see_to(std::size_t place, const Wishes& wishes, std::int64_t now_ns) noexcept;
  void see_to_likely(const Wishes& wishes, std::int64_t now_ns) noexcept;
  bool make_colder_room(ZoneId zone, const Foresight& foresight) noexcept;
  bool would_stay(ZoneId zone, const Wishes& wishes) const noexcept;
  bool may_start(ZoneId zone, Demand demand, std::int64_t now_ns) noexcept;
  void keep_pinned(std::int64_t now_ns) noexcept;
  Result<std::size_t> admit(ZoneId zone, Purpose purpose) noexcept;
  void cancel_load() noexcept;
  void fail(ZoneId zone, ErrorCode code, std::int64_t now_ns) noexcept;
  void set_blocked(ZoneId zone) noexcept;
  void emit(EventKind kind, ZoneId zone, const char* reason = nullptr) noexcept;

  Residency& memory_;
  ZoneLoader& loader_;
  EventStamper& events_;
  std::span<const ZoneNeed> needs_;
  std::vector<ZoneId> pinned_;  // capacity for kMostPins more
  std::size_t most_pins_;
  ZoneDirectory* directory_;
  ZoneKeeperSettings settings_;
  std::vector<Retry> retries_;
  std::array<ZoneId, kMaxWanted> wanted_{};
  std::size_t wanted_count_ = 0;
  std::size_t needed_count_ = 0;  // of these
  bool held_ = false;
  ZoneId loading_ = kNoZone;
  bool loads_useful_ = false;  // what is loading is only useful or likely
  // Likely zones whose load began by this foresight: one that lost its room again is not loaded
  // twice by the same, as it would only lose it once more.
  std::array<ZoneId, kMaxWanted> tried_{};
  std::size_t tried_count_ = 0;
  std::uint32_t tried_by_ = 0;
  ZoneId blocked_ = kNoZone;
  ZoneId does_not_fit_ = kNoZone;  // the most urgent one of this cycle
};

}  // namespace zonepack
