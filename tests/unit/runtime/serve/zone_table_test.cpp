// SPDX-License-Identifier: Apache-2.0
#include "runtime/serve/zone_table.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <vector>

namespace zonepack {
namespace {

Event event_of(EventKind kind, ZoneId zone, std::uint32_t generation) {
  Event event;
  event.kind = kind;
  event.zone = zone;
  event.generation = generation;
  return event;
}

TEST(ZoneTable, FollowsAZoneThroughItsLife) {
  ZoneTable table(2);
  table.take(event_of(EventKind::kLoadStarted, 1, 1));
  EXPECT_EQ(table[1].state, ZoneState::kFilling);
  table.take(event_of(EventKind::kLoadCancelled, 1, 1));
  EXPECT_EQ(table[1].state, ZoneState::kCancelling);
  EXPECT_EQ(table.totals().filling, 1u);
  table.take(event_of(EventKind::kLoadDone, 1, 1));  // finished anyway
  EXPECT_TRUE(table[1].resident());
  EXPECT_EQ(table.totals().filling, 0u);
  EXPECT_EQ(table.totals().resident, 1u);
  table.take(event_of(EventKind::kEvicted, 1, 1));
  EXPECT_EQ(table[1].state, ZoneState::kAbsent);
  EXPECT_EQ(table.counter(), 2u);
  table.take(event_of(EventKind::kLoadStarted, 7, 1));  // of no zone here
}

TEST(ZoneTable, LoadsThatFailChangeNothingForReaders) {
  ZoneTable table(1);
  table.take(event_of(EventKind::kLoadStarted, 0, 1));
  table.take(event_of(EventKind::kLoadFailed, 0, 1));
  EXPECT_EQ(table[0].state, ZoneState::kAbsent);
  EXPECT_EQ(table.counter(), 0u);
}

TEST(ZoneTable, AfterLostEventsTakesWhatReadersSeeAndNotWhatIsOlder) {
  ZoneTable table(3);
  table.take(event_of(EventKind::kLoadDone, 0, 1));
  table.take(event_of(EventKind::kLoadDone, 1, 4));
  table.take(event_of(EventKind::kZoneWanted, 1, 4));
  // Lost: zone 0 evicted, zone 1 evicted and loaded anew, zone 2 loaded.
  const std::optional<std::uint32_t> truth[] = {std::nullopt, 5, 2};
  table.resync([&](ZoneId zone) { return truth[zone]; });
  EXPECT_FALSE(table[0].resident());
  EXPECT_EQ(table[1].generation, 5u);
  EXPECT_TRUE(table[2].resident());
  EXPECT_FALSE(table[1].wanted);
  EXPECT_EQ(table.totals().resident, 2u);
  EXPECT_EQ(table.counter(), 5u) << "three changes, of which zone 1's is told too";
  table.take(event_of(EventKind::kEvicted, 1, 4));  // was in the queue
  EXPECT_TRUE(table[1].resident());
}

TEST(ZoneTable, PinsAndLeasesAreWhatTheServerNotes) {
  const ZoneId pinned[] = {1};
  ZoneTable table(2, pinned);
  EXPECT_TRUE(table[1].pinned);
  table.set_pinned(0, true);
  table.set_pinned(0, true);
  table.set_pinned(1, false);
  EXPECT_EQ(table.totals().pinned, 1u);
  table.add_leases(0, 1);
  table.add_leases(0, 1);
  table.add_leases(0, -1);
  EXPECT_EQ(table[0].leases, 1u);
}

// A client that catches up from any point knows what the table knows.
TEST(ZoneTable, CatchingUpFromAnyPointEndsWithTheSameZones) {
  constexpr ZoneId kZones = 20;
  ZoneTable table(kZones);
  std::mt19937 random(3);
  std::vector<std::uint32_t> generations(kZones, 0);
  std::map<ZoneId, bool> known[3];
  std::uint64_t told[3] = {};
  for (int step = 0; step < 5000; ++step) {
    const auto zone = static_cast<ZoneId>(random() % kZones);
    const bool load = !table[zone].resident();
    generations[zone] += load ? 1 : 0;
    table.take(
        event_of(load ? EventKind::kLoadDone : EventKind::kEvicted, zone, generations[zone]));
    for (std::size_t client = 0; client < 3; ++client) {
      if (random() % (1 + 10 * client) != 0) continue;
      for (ZoneId z = table.first_changed_after(told[client]); z != kNoZone; z = table[z].newer) {
        known[client][z] = table[z].resident();
        EXPECT_GT(table[z].changed_at, told[client]);
        told[client] = table[z].changed_at;
      }
      ASSERT_EQ(told[client], table.counter());
      for (const auto& [z, resident] : known[client]) ASSERT_EQ(resident, table[z].resident());
    }
  }
}

}  // namespace
}  // namespace zonepack
