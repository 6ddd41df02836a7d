// SPDX-License-Identifier: Apache-2.0
#include "runtime/control/map_switcher.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "runtime/run/maps/modelled_loader.hpp"
#include "tests/support/rooms.hpp"
#include "tests/support/sample_catalog.hpp"

namespace zonepack {
namespace {

// Three rooms a, b, c in a row (rooms.hpp), 4 slots of 100 bytes each, room for nine; tables of 100
// bytes. A load takes 0.1 s.
struct World {
  World(ZoneLoader& loader, EventSink& events, ZoneDirectory& directory, ByteCount budget)
      : memory(3, {.budget = budget,
                   .fixed = 100,
                   .slot_bytes = 100,
                   .largest_pair = {.slots = 8, .signatures = 20}}),
        cycle(testing_support::sample_robot(), {.graph = graph,
                                                .needs = needs,
                                                .load_s = load_s,
                                                .pinned = {},
                                                .memory = memory,
                                                .loader = loader,
                                                .events = events,
                                                .directory = &directory}) {}

  Catalog catalog;
  const ZoneGraph graph = testing_support::three_rooms();
  const std::vector<ZoneNeed> needs =
      std::vector<ZoneNeed>(3, ZoneNeed{.slots = 4, .signatures = 10});
  const std::vector<float> load_s = std::vector<float>(3, 0.12f);
  Residency memory;
  Cycle cycle;
  MapInUse in_use{
      .catalog = catalog, .graph = graph, .needs = needs, .memory = memory, .cycle = cycle};
};

class MapChange : public testing::Test, public EventSink, public ZoneDirectory, public ZoneFiller {
 protected:
  MapChange() { words.reserve(4096); }

  void on_event(const Event& event) noexcept override {
    std::string word = to_string(event.kind);
    if (event.zone != kNoZone) word += " " + old_world.graph.name(event.zone);
    if (event.reason != nullptr) word += std::string(" ") + event.reason;
    words.push_back(word);
  }
  void publish(ZoneId zone, std::uint32_t, const SlotChain&) noexcept override {
    readable[zone] = true;
  }
  void withdraw(ZoneId zone) noexcept override { readable[zone] = false; }
  Result<void> begin_map(std::uint32_t) noexcept override {
    for (const bool zone : readable) EXPECT_FALSE(zone);
    return {};
  }
  Result<void> fill(ZoneId, std::span<const SlotIndex>) override {
    if (broken) return ErrorCode::kBadChecksum;
    return {};
  }

  void step(std::vector<PoseCorrection> fixes = {}, std::vector<Command> commands = {}) {
    now_ns += 10'000'000;
    loader.advance_to(now_ns);
    std::vector<LoadResult> loads;
    while (const auto load = loader.poll()) loads.push_back(*load);
    maps.run({.now_ns = now_ns, .corrections = fixes, .loads = loads, .commands = commands});
    EXPECT_LE(old_world.memory.charged(), 1000u);
    EXPECT_LE(new_world.memory.charged(), 1000u);
  }

  void stand(int cycles) {
    for (int i = 0; i < cycles; ++i) step();
  }

  PoseCorrection fix_in_a() const {
    return {.stamp_ns = now_ns,
            .received_ns = now_ns,
            .T_map_base = {2, 2, 0},
            .sigma_x_m = 0.03,
            .sigma_y_m = 0.03,
            .sigma_yaw_rad = 0.01};
  }

  // Trusted in room a, with a hint that keeps its neighbour in memory too.
  void stand_in_a() {
    step();
    step({fix_in_a()});
    Command hint;
    hint.kind = Command::Kind::kRouteHint;
    hint.route_length = 2;
    hint.route = {0, 1};
    step({fix_in_a()}, {hint});
    stand(40);
    ASSERT_TRUE(old_world.memory.resident(0) && old_world.memory.resident(1));
    ASSERT_TRUE(maps.map().cycle.state().map_ready);
    words.clear();
  }

  bool told(const std::string& word) const {
    return std::find(words.begin(), words.end(), word) != words.end();
  }

  bool readable[3] = {};
  bool broken = false;
  std::vector<std::string> words;
  std::vector<LoadWork> work = std::vector<LoadWork>(3, LoadWork{.stored_bytes = 100});
  ModelledLoader loader{9, work, {.storage = 1000, .decode = 1000}, this};
  World old_world{loader, *this, *this, 1000};
  World new_world{loader, *this, *this, 1000};
  MapSwitcher maps{old_world.in_use, loader, this};
  std::int64_t now_ns = 1'000'000'000;
};

TEST_F(MapChange, LoadsTheRobotsZoneOfTheNewMapNextToTheOldOneThenChanges) {
  stand_in_a();
  ASSERT_TRUE(maps.offer(new_world.in_use));
  step();
  EXPECT_EQ(words, (std::vector<std::string>{"map_offered", "evicted b"}));
  stand(4);
  EXPECT_TRUE(old_world.memory.resident(0));  // still served, while the new one's is loaded
  EXPECT_EQ(old_world.memory.charged(), 100u + 400 + 400 + 100);
  stand(20);
  EXPECT_EQ(&maps.map(), &new_world.in_use);
  EXPECT_TRUE(new_world.memory.resident(0));
  EXPECT_TRUE(readable[0]);
  EXPECT_TRUE(maps.map().cycle.state().map_ready);
  EXPECT_EQ(maps.take_unused(), &old_world.in_use);
  EXPECT_EQ(maps.take_unused(), nullptr);
  EXPECT_EQ(maps.map().cycle.state().pose.T_map_base.x_m, 2);
  EXPECT_EQ(new_world.memory.counters().zones_loaded, 3u);  // a and b, and a again
}

TEST_F(MapChange, KeepsRoomForTheOldTablesUntilTheyAreGone) {
  stand_in_a();
  maps.offer(new_world.in_use);
  stand(30);
  EXPECT_EQ(new_world.memory.charged(), 100u + 400 + 100);
  Command freed;
  freed.kind = Command::Kind::kMapFreed;
  step({}, {freed});
  EXPECT_EQ(new_world.memory.charged(), 100u + 400);
}

TEST_F(MapChange, KeepsTheOldMapWhenTheZoneCannotBeLoaded) {
  stand_in_a();
  broken = true;
  maps.offer(new_world.in_use);
  stand(30);
  EXPECT_TRUE(told("map_refused bad checksum"));
  EXPECT_EQ(&maps.map(), &old_world.in_use);
  EXPECT_EQ(maps.take_unused(), &new_world.in_use);
  EXPECT_TRUE(old_world.memory.resident(0) && readable[0]);
  broken = false;
  stand(200);
  EXPECT_TRUE(old_world.memory.resident(1));  // loads go on
}

TEST_F(MapChange, KeepsTheOldMapWhenBothDoNotFit) {
  World large{loader, *this, *this, 100 + 900};
  const std::vector<ZoneNeed> needs(3, ZoneNeed{.slots = 5, .signatures = 10});
  MapInUse in_use{.catalog = large.catalog,
                  .graph = large.graph,
                  .needs = needs,
                  .memory = large.memory,
                  .cycle = large.cycle};
  stand_in_a();
  maps.offer(in_use);  // 100 + 400 + 100 + 500 > 1000
  stand(5);
  EXPECT_TRUE(told("map_refused no room"));
  EXPECT_TRUE(old_world.memory.resident(0));
}

TEST_F(MapChange, KeepsTheOldMapWhenThereAreNotEnoughSlotsHoweverLargeTheBudget) {
  World roomy{loader, *this, *this, 10'000};
  MapInUse in_use{.catalog = roomy.catalog,
                  .graph = roomy.graph,
                  .needs = roomy.needs,
                  .memory = roomy.memory,
                  .cycle = roomy.cycle,
                  .number = 2,
                  .slots = 7};
  stand_in_a();
  maps.offer(in_use);  // 4 of the old one and 4 of the new one
  stand(5);
  EXPECT_TRUE(told("map_refused no room"));
  EXPECT_TRUE(old_world.memory.resident(0));
}

TEST_F(MapChange, KeepsTheOldMapWhenTheNewOneHasNoRoomForTheOldTables) {
  World small{loader, *this, *this, 100 + 400};
  MapInUse in_use{.catalog = small.catalog,
                  .graph = small.graph,
                  .needs = small.needs,
                  .memory = small.memory,
                  .cycle = small.cycle,
                  .number = 2};
  stand_in_a();
  maps.offer(in_use);
  stand(5);
  EXPECT_TRUE(told("map_refused no room"));
}

TEST_F(MapChange, SaysWhyAMapToBeOfferedCannotBeUsed) {
  stand_in_a();
  maps.run({now_ns += 10'000'000, {}, {}, {}, {}, {0, ErrorCode::kTruncated}});
  EXPECT_TRUE(told("map_offered") && told("map_refused truncated"));
  EXPECT_FALSE(maps.changing());
}

TEST_F(MapChange, IsRefusedWhileNothingMayBeEvicted) {
  stand_in_a();
  Command freeze;
  freeze.kind = Command::Kind::kFreeze;
  step({}, {freeze});
  maps.offer(new_world.in_use);
  step();
  EXPECT_TRUE(told("map_refused frozen"));
  EXPECT_TRUE(old_world.memory.resident(1));
}

TEST_F(MapChange, ChangesAtOnceWhereNoPoseIsKnown) {
  step();
  maps.offer(new_world.in_use);
  stand(2);
  EXPECT_TRUE(told("map_changed"));
  EXPECT_EQ(&maps.map(), &new_world.in_use);
}

// Both maps with zones a, b and c; packs differ where the digests do.
class MapUpdateWhileDriving : public MapChange {
 protected:
  void name_zones(World& world, std::array<std::uint8_t, 3> packs) {
    const char* const names[] = {"a", "b", "c"};
    for (std::size_t i = 0; i < 3; ++i) {
      CatalogZone& zone = world.catalog.zones.emplace_back();
      zone.name = names[i];
      zone.slots = 4;
      zone.signatures = 10;
      zone.pack_digest[0] = packs[i];
    }
  }
  // The recorded offer, as the robot makes it, in the next cycle.
  void take_update(bool keeps = true) {
    new_world.in_use.number = 2;
    ASSERT_TRUE(maps.offer(new_world.in_use));
    now_ns += 10'000'000;
    loader.advance_to(now_ns);
    maps.run({.now_ns = now_ns, .offer = {.map = 2, .keeps = keeps}});
    stand(30);
    ASSERT_EQ(&maps.map(), &new_world.in_use);
  }
  std::size_t count(const std::string& word) const {
    return static_cast<std::size_t>(std::count(words.begin(), words.end(), word));
  }
};

TEST_F(MapUpdateWhileDriving, KeepsWhatIsTheSameAndLoadsNothingAgain) {
  name_zones(old_world, {1, 2, 3});
  name_zones(new_world, {1, 2, 9});
  stand_in_a();
  const std::uint64_t loaded = old_world.memory.counters().zones_loaded;
  take_update();
  EXPECT_TRUE(new_world.memory.resident(0) && new_world.memory.resident(1));
  EXPECT_TRUE(readable[0] && readable[1]);
  EXPECT_TRUE(maps.map().cycle.state().map_ready);
  EXPECT_EQ(new_world.memory.counters().zones_loaded, loaded);
  EXPECT_EQ(new_world.memory.counters().zones_unloaded, 0u);
  EXPECT_EQ(count("load_started a") + count("load_started b") + count("evicted b"), 0u);
  EXPECT_EQ(count("zone_kept a"), 1u);
  EXPECT_EQ(count("zone_kept b"), 1u);
  EXPECT_EQ(old_world.memory.used_sum(), NeedSum{});
}

TEST_F(MapUpdateWhileDriving, LoadsTheRobotsZoneWhenItChangedAndKeepsTheOther) {
  // Budget 1000: tables 100 twice, a twice and b: 200 + 3 x 400 = 1400. So b has to go.
  name_zones(old_world, {1, 2, 3});
  name_zones(new_world, {8, 2, 3});
  stand_in_a();
  take_update();
  EXPECT_EQ(count("zone_kept a"), 0u);
  EXPECT_EQ(count("zone_kept b"), 0u);
  EXPECT_EQ(count("evicted b"), 1u);
  EXPECT_EQ(count("load_done a"), 1u);
  EXPECT_TRUE(maps.map().cycle.state().map_ready);
}

TEST_F(MapUpdateWhileDriving, KeepsTheRobotsZoneWhenItsNeighbourChanged) {
  name_zones(old_world, {1, 2, 3});
  name_zones(new_world, {1, 7, 3});
  stand_in_a();
  take_update();
  EXPECT_EQ(count("zone_kept a"), 1u);
  EXPECT_EQ(count("evicted b"), 1u);  // another pack
  EXPECT_EQ(count("load_started a"), 0u);
  EXPECT_TRUE(new_world.memory.resident(0));
}

TEST_F(MapUpdateWhileDriving, LoadsEverythingAgainWhereARecordingSaysSo) {
  name_zones(old_world, {1, 2, 3});
  name_zones(new_world, {1, 2, 3});
  stand_in_a();
  take_update(false);
  EXPECT_EQ(count("zone_kept a") + count("zone_kept b"), 0u);
  EXPECT_EQ(count("evicted b"), 1u);
  EXPECT_EQ(count("load_done a"), 1u);
}

}  // namespace
}  // namespace zonepack
