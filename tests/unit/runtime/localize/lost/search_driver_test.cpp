// SPDX-License-Identifier: Apache-2.0
// Two zones, of which a made-up world loads what it is asked for when a test says so.
#include "runtime/localize/lost/search_driver.hpp"

#include <gmock/gmock.h>

#include <set>
#include <utility>

#include "tests/unit/runtime/localize/lost/made_places.hpp"

namespace zonepack::localize {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;
using Kind = Command::Kind;

constexpr std::int64_t kDriverSecond_ns = 1'000'000'000;

class MadeWorld final : public SearchWorld {
 public:
  std::set<ZoneId> in_memory;
  bool unloads = false;  // before it is read
  std::vector<std::pair<Kind, ZoneId>> commands;

  bool resident(ZoneId zone) const override { return in_memory.contains(zone); }
  std::optional<std::vector<MapFeatures>> read(ZoneId) override {
    if (unloads) return std::nullopt;
    return std::vector<MapFeatures>(7);
  }
  Result<void> command(Kind kind, ZoneId zone) override {
    commands.emplace_back(kind, zone);
    return {};
  }
};

class SearchDriverTest : public testing::Test {
 protected:
  // The image `number`, taken x_m from where the wheels began.
  void see(std::int64_t number, double x_m) {
    driver.follow(number * kDriverSecond_ns / 2, {x_m, 0, 0});
    EXPECT_TRUE(driver.see(number * kDriverSecond_ns / 2, {}));
  }
  std::vector<FoundFix> step(double second) {
    return driver.step(static_cast<std::int64_t>(second * 1e9)).value();
  }

  MadeWorld world;
  MadePlaces places;
  SearchDriver driver{{{10, {0, 0}, {1}}, {30, {10, 0}, {0}}}, places, world};
};

TEST_F(SearchDriverTest, GivesThePoseUpAndAsksForAZoneOnce) {
  ASSERT_TRUE(driver.begin(0, 1));
  EXPECT_TRUE(driver.active());
  step(0.1);  // nothing was seen yet
  EXPECT_THAT(world.commands, ElementsAre(Pair(Kind::kLost, kNoZone)));
  see(1, 0);
  step(0.6);
  step(0.7);
  EXPECT_THAT(world.commands, ElementsAre(Pair(Kind::kLost, kNoZone), Pair(Kind::kSeek, 1u)));
  EXPECT_EQ(driver.figures().zones_looked_at, 0u);
}

// One view against seven signatures; then the other zone is asked for.
TEST_F(SearchDriverTest, LooksAtWhatWasLoadedAndGoesOn) {
  ASSERT_TRUE(driver.begin(0, 1));
  see(1, 0);
  step(0.6);
  world.in_memory = {1};
  step(0.7);
  EXPECT_EQ(places.looks, 1);
  EXPECT_EQ(driver.figures().pairs, 7u);
  EXPECT_EQ(driver.figures().zones_looked_at, 1u);
  step(0.8);
  EXPECT_THAT(world.commands.back(), Pair(Kind::kSeek, 0u));
}

TEST_F(SearchDriverTest, LooksAgainAtAZoneThatWasUnloadedUnderIt) {
  ASSERT_TRUE(driver.begin(0, 1));
  see(1, 0);
  world.in_memory = {1};
  world.unloads = true;
  step(0.6);
  EXPECT_EQ(places.looks, 0);
  world.unloads = false;
  step(0.7);
  EXPECT_EQ(places.looks, 1);
}

TEST_F(SearchDriverTest, AsksForATurnWhenNothingFits) {
  ASSERT_TRUE(driver.begin(0, 1));
  see(1, 0);
  world.in_memory = {0, 1};
  step(0.6);
  step(0.7);
  EXPECT_THAT(world.commands.back(), Pair(Kind::kAskTurn, kNoZone));
  EXPECT_EQ(driver.figures().turns_asked, 1u);
}

// Three views agree. A second later, when zoned still is lost, the search goes on.
TEST_F(SearchDriverTest, WaitsForItsFixesToBeBelieved) {
  ASSERT_TRUE(driver.begin(0, 1));
  for (std::int64_t i = 1; i <= 3; ++i) {
    const double x_m = 0.2 * static_cast<double>(i);
    see(i, x_m);
    places.guesses[{static_cast<std::uint64_t>(i), 1}] = {made_sight({x_m, 5, 0}, 60, 100)};
  }
  world.in_memory = {1};
  EXPECT_EQ(step(2).size(), 3u);
  EXPECT_TRUE(driver.waits(3 * kDriverSecond_ns));
  EXPECT_THAT(step(2.5), IsEmpty());
  EXPECT_FALSE(driver.waits(3 * kDriverSecond_ns + 1));
  EXPECT_EQ(step(3.1).size(), 3u);
  driver.end();
  EXPECT_FALSE(driver.active());
  EXPECT_FALSE(driver.waits(3 * kDriverSecond_ns));
  EXPECT_TRUE(driver.sweep().search().views().empty());
}

TEST_F(SearchDriverTest, TakesNoImageWithoutWheels) {
  ASSERT_TRUE(driver.begin(0, 1));
  EXPECT_FALSE(driver.see(0, {}));
}

}  // namespace
}  // namespace zonepack::localize
