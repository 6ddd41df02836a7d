// SPDX-License-Identifier: Apache-2.0
#include "runtime/evaluate/choices.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "runtime/pack_format/file/accounting.hpp"

namespace zonepack {
namespace {

constexpr ByteCount kSlot = kSlotBytes + kTableBytesPerSlot;

// A lobby of 10 slots between two rooms of 4 and 6; 1000 bytes fixed.
Catalog lobby() {
  Catalog catalog;
  catalog.fixed_bytes = 1000;
  for (const auto& [name, slots] : {std::pair("lobby", 10u), {"room1", 4u}, {"room2", 6u}}) {
    CatalogZone zone;
    zone.name = name;
    zone.slots = slots;
    zone.signatures = slots * 10;
    zone.stored_bytes = slots * 1000;
    catalog.zones.push_back(zone);
  }
  for (const ZoneId room : {1u, 2u}) {
    CatalogPortal portal;
    portal.zone_a = 0;
    portal.zone_b = room;
    portal.segment = {{0, 0}, {1, 0}};
    catalog.portals.push_back(portal);
  }
  return catalog;
}

Evaluation one_map() {
  Evaluation evaluation;
  evaluation.maps.push_back({"map", lobby(), {}});
  evaluation.drives.resize(2);
  return evaluation;
}

TEST(AutoBudgets, GoFromTheSmallestToTheWholeMapInWholeSlots) {
  // Lobby and room2 are 16 slots, all are 20: 16 + 4 * step / 7 rounded down, each once.
  const auto budgets = auto_budgets(lobby(), {});
  ASSERT_EQ(budgets.size(), 5u);
  for (std::size_t i = 0; i < budgets.size(); ++i) EXPECT_EQ(budgets[i], 1000 + (16 + i) * kSlot);
}

TEST(AutoBudgets, MakeRoomForPins) {
  // room1 is always held: lobby, room2 and room1 are the whole map.
  EXPECT_EQ(auto_budgets(lobby(), {1}), std::vector<ByteCount>{1000 + 20 * kSlot});
}

TEST(Choices, AreEveryCombinationTheLastChangingFirst) {
  EvaluateArguments arguments;
  arguments.budgets = {1000 + 16 * kSlot, 1000 + 18 * kSlot};
  arguments.evictions = {"lru", "sieve"};
  arguments.preloads = {"none", "portal"};
  arguments.storage_rates = {1'000'000, 2'000'000};
  const auto choices = choices_of(arguments, one_map());
  ASSERT_TRUE(choices.ok()) << choices.error().message;
  ASSERT_EQ(choices->size(), 2u * 2 * 2 * 2 * 2);
  std::set<std::string> all;
  for (const Choice& choice : *choices) {
    all.insert(std::to_string(choice.drive) + " " + std::to_string(*choice.budget) + " " +
               std::string(choice.eviction->name) + " " + std::string(choice.preload->name) + " " +
               std::to_string(choice.storage_rate));
  }
  EXPECT_EQ(all.size(), choices->size());
  EXPECT_EQ((*choices)[0].storage_rate, 1'000'000u);
  EXPECT_EQ((*choices)[1].storage_rate, 2'000'000u);
  EXPECT_EQ((*choices)[2].preload->name, "portal");
  EXPECT_EQ((*choices)[16].drive, 1u);
}

TEST(Choices, TakeFromTheSettingsWhatIsNotGiven) {
  Evaluation evaluation = one_map();
  evaluation.settings.memory.budget = 1000 + 17 * kSlot;
  evaluation.settings.memory.max_signatures = 170;
  evaluation.settings.loading.storage_rate = 123'456;
  const auto choices = choices_of({}, evaluation);
  ASSERT_TRUE(choices.ok()) << choices.error().message;
  ASSERT_EQ(choices->size(), 2u);
  const Choice& choice = choices->front();
  EXPECT_EQ(choice.budget, 1000 + 17 * kSlot);
  EXPECT_EQ(choice.max_signatures, 170u);
  EXPECT_EQ(choice.storage_rate, 123'456u);
  EXPECT_EQ(choice.eviction->name, "lru");
  EXPECT_EQ(choice.preload->name, "portal");
}

TEST(Choices, TryAllBudgetsWhereNothingLimits) {
  const auto choices = choices_of({}, one_map());
  ASSERT_TRUE(choices.ok()) << choices.error().message;
  EXPECT_EQ(choices->size(), 2u * 5);
}

TEST(Choices, TryGivenBudgetsAmongThoseOfAuto) {
  EvaluateArguments arguments;
  arguments.auto_budgets = true;
  arguments.budgets = {1000 + 30 * kSlot, 1000 + 16 * kSlot};
  const auto choices = choices_of(arguments, one_map());
  ASSERT_TRUE(choices.ok()) << choices.error().message;
  // Five, of which one was given too, and one over the whole map.
  ASSERT_EQ(choices->size(), 2u * 6);
  EXPECT_EQ(choices->back().budget, 1000 + 30 * kSlot);
}

TEST(Choices, LeaveTheBudgetOpenWhereSignaturesAreLimited) {
  EvaluateArguments arguments;
  arguments.max_signatures = {160, 180};
  const auto choices = choices_of(arguments, one_map());
  ASSERT_TRUE(choices.ok()) << choices.error().message;
  EXPECT_EQ(choices->size(), 2u * 2);
  EXPECT_TRUE(std::ranges::none_of(*choices, [](const Choice& c) { return c.budget.has_value(); }));
}

TEST(Choices, RefuseABudgetThatAMapDoesNotFitAndNameTheMap) {
  EvaluateArguments arguments;
  arguments.budgets = {1000 + 18 * kSlot, 1000 + 9 * kSlot};
  const auto choices = choices_of(arguments, one_map());
  ASSERT_FALSE(choices.ok());
  EXPECT_EQ(choices.error().message.rfind("map: zone lobby", 0), 0u) << choices.error().message;
}

TEST(ParseBudgets, TakesSizesOrAuto) {
  EvaluateArguments arguments;
  EXPECT_TRUE(parse_budgets("8MiB,1000", arguments));
  EXPECT_EQ(arguments.budgets, (std::vector<ByteCount>{8 * kMiB, 1000}));
  EXPECT_FALSE(arguments.auto_budgets);
  EXPECT_TRUE(parse_budgets("auto", arguments));
  EXPECT_TRUE(arguments.auto_budgets);
  for (const char* const wrong : {"", "8MiB,", ",8MiB", "8MiB,auto", "much"}) {
    EvaluateArguments fresh;
    EXPECT_FALSE(parse_budgets(wrong, fresh)) << wrong;
  }
}

TEST(ParseNames, TakesThoseThatAreKnownAndNamesTheFirstOther) {
  const auto names = parse_names("lru,sieve", eviction_names());
  ASSERT_TRUE(names);
  EXPECT_EQ(*names, (std::vector<std::string>{"lru", "sieve"}));
  const auto wrong = parse_names("lru,belady,fifo", eviction_names());
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().message.find("there is no 'belady'"), 0u) << wrong.error().message;
}

}  // namespace
}  // namespace zonepack
