// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "platform/base/byte_count.hpp"
#include "runtime/control/event.hpp"
#include "runtime/memory/residency.hpp"
#include "runtime/pack_format/ids.hpp"

namespace zonepack {

// The generation of a zone that readers can read now, else nothing.
using ResidentGeneration = std::function<std::optional<std::uint32_t>(ZoneId)>;

// The state of every zone as events report it, so that the control thread is never asked; and the
// order of changes, so that a client can catch up from any point.
//
// Threads: one, the server's. Does not allocate after construction.
class ZoneTable {
 public:
  struct Row {
    std::uint64_t changed_at = 0;  // counter() when the zone last became resident or ceased to be
    std::uint32_t generation = 0;
    ZoneId older = kNoZone, newer = kNoZone;  // neighbours in the order of changed_at
    std::uint16_t leases = 0;                 // that the server granted and has not seen end
    ZoneState state = ZoneState::kAbsent;
    bool wanted : 1 = false;
    bool pinned : 1 = false;

    bool resident() const noexcept { return state == ZoneState::kResident; }
  };
  struct Totals {
    std::uint32_t resident = 0, filling = 0, pinned = 0;
  };

  explicit ZoneTable(std::size_t zones, std::span<const ZoneId> pinned = {});

  void take(const Event& event) noexcept;

  // Call when events were lost: residency is read anew, and no zone counts as wanted until the next
  // event about it.
  void resync(const ResidentGeneration& resident);

  void set_pinned(ZoneId zone, bool pinned) noexcept;
  void add_leases(ZoneId zone, int change) noexcept;

  std::size_t size() const noexcept { return rows_.size(); }
  const Row& operator[](ZoneId zone) const noexcept { return rows_[zone]; }
  const Totals& totals() const noexcept { return totals_; }

  // How often a zone has become resident or ceased to be.
  std::uint64_t counter() const noexcept { return counter_; }

  // The zone whose last change is the first after `since`; kNoZone when there is none. The next
  // ones follow by `newer`.
  ZoneId first_changed_after(std::uint64_t since) const noexcept;

  static ByteCount table_bytes(std::size_t zones) noexcept { return zones * sizeof(Row); }

 private:
  void set_state(ZoneId zone, ZoneState state) noexcept;
  void mark_changed(ZoneId zone) noexcept;

  std::vector<Row> rows_;
  ZoneId oldest_ = kNoZone, newest_ = kNoZone;
  std::uint64_t counter_ = 0;
  Totals totals_;
};
static_assert(sizeof(ZoneTable::Row) <= 32);

}  // namespace zonepack
