// SPDX-License-Identifier: Apache-2.0
#include "runtime/serve/zone_activity.hpp"

#include <gtest/gtest.h>

namespace zonepack {
namespace {

Event event(EventKind kind, ZoneId zone, std::int64_t t_ns = 0) {
  Event made;
  made.kind = kind;
  made.zone = zone;
  made.t_ns = t_ns;
  return made;
}

TEST(ZoneActivity, CountsWhatHappensToAZone) {
  ZoneActivity activity;
  activity.take(event(EventKind::kLoadStarted, 7, 1'000));
  activity.take(event(EventKind::kLoadDone, 7, 1'250));
  activity.take(event(EventKind::kZoneEntered, 7, 2'000));
  activity.take(event(EventKind::kEvicted, 7, 3'000));
  activity.take(event(EventKind::kLoadStarted, 7, 4'000));
  activity.take(event(EventKind::kLoadDone, 7, 4'100));
  activity.take(event(EventKind::kZoneWanted, 3));         // counts nothing
  activity.take(event(EventKind::kZoneEntered, kNoZone));  // in no zone
  ASSERT_EQ(activity.rows().size(), 1u);
  const ZoneActivity::Row row = activity.of(7);
  EXPECT_EQ(row.loads, 2u);
  EXPECT_EQ(row.evictions, 1u);
  EXPECT_EQ(row.entered, 1u);
  EXPECT_EQ(row.last_load_ns, 100);  // 4100 - 4000
  EXPECT_EQ(activity.of(3).loads, 0u);
}

TEST(ZoneActivity, KeepsNoMoreZonesThanItsBoundHoweverLargeTheMap) {
  ZoneActivity activity;
  constexpr auto kMost = static_cast<ZoneId>(ZoneActivity::kMostZones);
  for (ZoneId zone = 2 * kMost; zone-- > 0;) activity.take(event(EventKind::kZoneEntered, zone));
  EXPECT_EQ(activity.rows().size(), ZoneActivity::kMostZones);
  // The first that something happened to were the last of the map.
  EXPECT_EQ(activity.rows().front().zone, kMost);
  EXPECT_EQ(activity.rows().back().zone, 2 * kMost - 1);
  activity.take(event(EventKind::kZoneEntered, kMost));
  EXPECT_EQ(activity.of(kMost).entered, 2u);
  EXPECT_EQ(activity.of(0).entered, 0u);
}

}  // namespace
}  // namespace zonepack
