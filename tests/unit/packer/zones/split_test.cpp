// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/split.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <random>
#include <stdexcept>
#include <string>

#include "packer/zones/plane.hpp"
#include "packer/zones/zone_checks.hpp"
#include "packer/zones/zone_file.hpp"

namespace zonepack::packer {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

PlannedZone zone_of(const std::string& name, Ring outer, std::vector<Ring> holes = {}) {
  PlannedZone zone;
  zone.name = name;
  zone.zone_type = "corridor";
  zone.polygon = with_interior_on_the_left({std::move(outer), std::move(holes)});
  return zone;
}

// Signatures with their weights, split as the packer does.
struct Case {
  ZonePlan plan;
  std::vector<SignaturePlace> places;
  std::vector<ByteCount> weights;

  void add(Point2 p, ByteCount weight) {
    places.push_back({static_cast<SignatureId>(places.size() + 1), p, 0});
    weights.push_back(weight);
  }
  SplitPlan split(ByteCount limit) const {
    const Partition before = partition(plan.zones, places, OrphanPolicy::kNearest);
    return split_oversized(plan, places, before.zone_of, weights, limit);
  }
};

std::vector<std::string> names(const ZonePlan& plan) {
  std::vector<std::string> result;
  for (const PlannedZone& zone : plan.zones) result.push_back(zone.name);
  return result;
}

// What must hold for every split: areas add up, parts are disjoint and connected by portals on
// their borders, every signature is in one part, by the rule, and no part is too heavy.
void expect_sound(const Case& input, const SplitPlan& result, ByteCount limit) {
  ASSERT_EQ(result.zone_of.size(), input.places.size());
  double area_before = 0, area_after = 0;
  for (const PlannedZone& zone : input.plan.zones) area_before += area_m2(zone.polygon);
  const auto& zones = result.plan.zones;
  for (std::size_t i = 0; i < zones.size(); ++i) {
    area_after += area_m2(zones[i].polygon);
    EXPECT_TRUE(self_crossings(zones[i].polygon.outer).empty()) << zones[i].name;
    EXPECT_GT(area_m2(zones[i].polygon), 0) << zones[i].name;
    for (std::size_t j = i + 1; j < zones.size(); ++j) {
      EXPECT_LT(zones[i].name, zones[j].name);
      MeasuringSteps steps(1'000'000);
      EXPECT_NEAR(common_area_m2(zones[i].polygon, zones[j].polygon, steps).value(), 0, 1e-6);
    }
  }
  EXPECT_NEAR(area_after, area_before, 1e-6);

  std::vector<ByteCount> weight(zones.size());
  for (std::size_t i = 0; i < input.places.size(); ++i) {
    weight.at(result.zone_of[i]) += input.weights[i];
  }
  for (std::size_t i = 0; i < zones.size(); ++i) EXPECT_LE(weight[i], limit) << zones[i].name;
  EXPECT_EQ(partition(zones, input.places, OrphanPolicy::kNearest).zone_of, result.zone_of);

  EXPECT_TRUE(unreachable_zones(result.plan).empty());
  for (const PlannedPortal& portal : result.plan.portals) {
    EXPECT_NE(portal.zone_a, portal.zone_b);
    EXPECT_GT(distance_m(portal.segment.p, portal.segment.q), 0);
    for (const std::uint32_t zone : {portal.zone_a, portal.zone_b}) {
      for (const Point2 p : {portal.segment.p, portal.segment.q}) {
        EXPECT_LE(distance_to_border_m(zones.at(zone).polygon, p), 1e-6) << portal.name;
      }
    }
  }
}

TEST(Split, LeavesALightZoneAsItIs) {
  Case input;
  input.plan.zones = {zone_of("H", {{0, 0}, {8, 0}, {8, 2}, {0, 2}})};
  input.add({1, 1}, 10);
  const SplitPlan result = input.split(10);
  EXPECT_THAT(names(result.plan), ElementsAre("H"));
  EXPECT_TRUE(result.split.empty());
  EXPECT_THAT(result.zone_of, ElementsAre(0));
}

TEST(Split, CutsACorridorAcrossItsLength) {
  Case input;
  input.plan.zones = {zone_of("H", {{0, 0}, {8, 0}, {8, 2}, {0, 2}})};
  for (const double x : {1.0, 3.0, 5.0, 7.0}) input.add({x, 1}, 10);
  const SplitPlan result = input.split(20);
  expect_sound(input, result, 20);
  EXPECT_THAT(names(result.plan), ElementsAre("H.1", "H.2"));
  EXPECT_EQ(result.plan.zones[0].parent, "H");
  EXPECT_EQ(result.plan.zones[0].zone_type, "corridor");
  EXPECT_THAT(result.zone_of, ElementsAre(0, 0, 1, 1));
  // The cut is midway between x = 3 and x = 5.
  ASSERT_EQ(result.plan.portals.size(), 1u);
  const PlannedPortal& door = result.plan.portals[0];
  EXPECT_EQ(door.name, "H.1-H.2");
  EXPECT_EQ(door.segment.p.x_m, 4);
  EXPECT_EQ(door.segment.q.x_m, 4);
  EXPECT_DOUBLE_EQ(distance_m(door.segment.p, door.segment.q), 2);
  ASSERT_EQ(result.split.size(), 1u);
  EXPECT_EQ(result.split[0].name, "H");
  EXPECT_EQ(result.split[0].parts, 2u);
  EXPECT_EQ(result.split[0].weight, 40u);
}

TEST(Split, MakesEveryLegOfAUAPartOfItsOwn) {
  Case input;
  input.plan.zones = {
      zone_of("U", {{0, 0}, {9, 0}, {9, 1}, {2, 1}, {2, 4}, {9, 4}, {9, 5}, {0, 5}})};
  for (const double x : {1.0, 2.5, 5.0, 8.0}) {
    input.add({x, 0.5}, 10);
    input.add({x, 4.5}, 10);
  }
  const SplitPlan result = input.split(40);
  expect_sound(input, result, 40);
  EXPECT_THAT(names(result.plan), ElementsAre("U.1", "U.2", "U.3"));
  EXPECT_EQ(result.plan.portals.size(), 2u);  // both lead to the bottom of the U
}

TEST(Split, CutsCrosswiseWhereSignaturesStandSideBySide) {
  Case input;
  input.plan.zones = {zone_of("H", {{0, 0}, {8, 0}, {8, 6}, {0, 6}})};
  for (const double y : {1.0, 2.0, 3.0, 4.0, 5.0}) input.add({4, y}, 10);
  const SplitPlan result = input.split(20);
  expect_sound(input, result, 20);
  EXPECT_GE(result.plan.zones.size(), 3u);
}

TEST(Split, GivesPortalsToThePartThatTheyTouch) {
  Case input;
  input.plan.zones = {zone_of("H", {{0, 0}, {8, 0}, {8, 2}, {0, 2}}),
                      zone_of("R1", {{0, 2}, {3, 2}, {3, 5}, {0, 5}}),
                      zone_of("R2", {{3, 2}, {8, 2}, {8, 5}, {3, 5}})};
  input.plan.portals = {{"D1", 0, 1, {{1, 2}, {2, 2}}}, {"D2", 2, 0, {{3.5, 2}, {7, 2}}}};
  for (const double x : {1.0, 3.0, 5.0, 7.0}) input.add({x, 1}, 10);
  const SplitPlan result = input.split(20);
  expect_sound(input, result, 20);
  // H is cut at x = 4, which D2 straddles.
  EXPECT_THAT(
      result.plan.portals,
      ElementsAre(
          PlannedPortal{.name = "D1", .zone_a = 0, .zone_b = 2, .segment = {{1, 2}, {2, 2}}},
          PlannedPortal{.name = "D2.1", .zone_a = 3, .zone_b = 0, .segment = {{3.5, 2}, {4, 2}}},
          PlannedPortal{.name = "D2.2", .zone_a = 3, .zone_b = 1, .segment = {{4, 2}, {7, 2}}},
          PlannedPortal{.name = "H.1-H.2", .zone_a = 0, .zone_b = 1, .segment = {{4, 0}, {4, 2}}}));
}

TEST(Split, SplitsAPortalBetweenTwoSplitZones) {
  Case input;
  input.plan.zones = {zone_of("A", {{0, 0}, {8, 0}, {8, 2}, {0, 2}}),
                      zone_of("B", {{0, 2}, {8, 2}, {8, 4}, {0, 4}})};
  input.plan.portals = {{"D", 0, 1, {{0.5, 2}, {7.5, 2}}}};
  for (const double x : {1.0, 7.0}) input.add({x, 1}, 10);  // A is cut at 4
  for (const double x : {1.0, 3.0}) input.add({x, 3}, 10);  // B is cut at 2
  const SplitPlan result = input.split(10);
  expect_sound(input, result, 10);
  EXPECT_THAT(
      result.plan.portals,
      ElementsAre(
          PlannedPortal{.name = "A.1-A.2", .zone_a = 0, .zone_b = 1, .segment = {{4, 0}, {4, 2}}},
          PlannedPortal{.name = "B.1-B.2", .zone_a = 2, .zone_b = 3, .segment = {{2, 2}, {2, 4}}},
          PlannedPortal{.name = "D.1", .zone_a = 0, .zone_b = 2, .segment = {{0.5, 2}, {2, 2}}},
          PlannedPortal{.name = "D.2", .zone_a = 0, .zone_b = 3, .segment = {{2, 2}, {4, 2}}},
          PlannedPortal{.name = "D.3", .zone_a = 1, .zone_b = 3, .segment = {{4, 2}, {7.5, 2}}}));
}

TEST(Split, KeepsOrphansWithTheirNearestPart) {
  Case input;
  input.plan.zones = {zone_of("H", {{0, 0}, {8, 0}, {8, 2}, {0, 2}})};
  for (const double x : {-3.0, 1.0, 7.0, 12.0}) input.add({x, 2.5}, 10);
  const SplitPlan result = input.split(20);
  expect_sound(input, result, 20);
  EXPECT_THAT(result.zone_of, ElementsAre(0, 0, 1, 1));
}

TEST(Split, CutsWhereOrphansTouchTheZoneNotWhereTheyStand) {
  Case input;
  input.plan.zones = {zone_of("H", {{0, 0}, {8, 0}, {8, 2}, {0, 2}})};
  for (const double x : {1.0, 3.0, 5.0, 7.0, 20.0, 21.0, 22.0, 23.0}) input.add({x, 1}, 10);
  // Midway between 7 and 20 there is nothing to cut; the orphans all belong to the end at x = 8.
  const SplitPlan result = input.split(40);
  expect_sound(input, result, 40);
  EXPECT_THAT(result.zone_of, ElementsAre(0, 0, 0, 0, 1, 1, 1, 1));
}

TEST(Split, LeavesDroppedSignaturesOut) {
  Case input;
  input.plan.zones = {zone_of("H", {{0, 0}, {8, 0}, {8, 2}, {0, 2}})};
  input.add({1, 1}, 10);
  input.add({20, 1}, 999);
  const SplitPlan result = split_oversized(
      input.plan, input.places, std::vector<std::uint32_t>{0, Partition::kNone}, input.weights, 10);
  EXPECT_THAT(result.zone_of, ElementsAre(0, Partition::kNone));
}

std::string refusal(const Case& input, ByteCount limit) {
  try {
    input.split(limit);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "nothing was refused";
}

TEST(Split, NamesASignatureThatIsTooHeavyAloneAndTheSmallestLimit) {
  Case input;
  input.plan.zones = {zone_of("H", {{0, 0}, {8, 0}, {8, 2}, {0, 2}})};
  input.add({1, 1}, 10);
  input.add({3, 1}, 31);
  EXPECT_EQ(refusal(input, 30),
            "zone 'H' cannot be split below 30: its signature 2 alone needs 31 bytes; raise "
            "--max-zone-bytes to 31 or more");
  expect_sound(input, input.split(31), 31);
}

TEST(Split, NamesSignaturesThatStandAtOnePlace) {
  Case input;
  input.plan.zones = {zone_of("H", {{0, 0}, {8, 0}, {8, 2}, {0, 2}})};
  for (int i = 0; i < 3; ++i) input.add({1, 1}, 10);
  input.add({3, 1}, 10);
  EXPECT_THAT(
      refusal(input, 20),
      HasSubstr("signatures 1, 2, 3 stand at one place, (1, 1), and together need 30 bytes"));
  expect_sound(input, input.split(30), 30);
}

TEST(Split, RefusesNamesOfPartsThatAreTakenOrTooLong) {
  Case input;
  input.plan.zones = {zone_of("H", {{0, 0}, {8, 0}, {8, 2}, {0, 2}}),
                      zone_of("H.2", {{8, 0}, {9, 0}, {9, 2}, {8, 2}})};
  input.add({1, 1}, 10);
  input.add({3, 1}, 10);
  EXPECT_THAT(refusal(input, 10), HasSubstr("a zone 'H.2' already"));
  input.plan.zones = {zone_of(std::string(63, 'x'), {{0, 0}, {8, 0}, {8, 2}, {0, 2}})};
  EXPECT_THAT(refusal(input, 10), HasSubstr("65 bytes long"));
}

TEST(Split, SortsMoreThanNinePartsByBytesAndNumbersThemAlongTheLength) {
  Case input;
  input.plan.zones = {zone_of("H", {{0, 0}, {22, 0}, {22, 2}, {0, 2}})};
  for (int i = 0; i < 11; ++i) input.add({1 + 2.0 * i, 1}, 10);
  const SplitPlan result = input.split(10);
  expect_sound(input, result, 10);
  EXPECT_EQ(result.plan.zones[1].name, "H.10");
  EXPECT_EQ(side_of(result.plan.zones[1].polygon, {19, 1}), Side::kInside);
  EXPECT_EQ(result.plan.portals.size(), 10u);
}

TEST(Split, HoldsForRandomStarsWithHoles) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> radius(2, 9), unit(0, 1);
  for (int round = 0; round < 60; ++round) {
    const int spikes = 5 + int(random() % 20);
    Ring outer, hole;
    for (int i = 0; i < spikes; ++i) {
      const double angle = 2 * 3.14159265358979 * (i + 0.7 * unit(random)) / spikes;
      const double r = radius(random);
      outer.push_back({3 * r * std::cos(angle), r * std::sin(angle)});
      hole.push_back({1.5 * std::cos(angle), 0.5 * std::sin(angle)});
    }
    Case input;
    const bool with_hole = round % 2 == 0;
    input.plan.zones = {
        zone_of("S", outer, with_hole ? std::vector<Ring>{hole} : std::vector<Ring>{})};
    ASSERT_TRUE(outline_faults(input.plan.zones[0].polygon).empty()) << round;
    ByteCount total = 0;
    while (input.places.size() < 80) {
      const Point2 p{(unit(random) - 0.5) * 54, (unit(random) - 0.5) * 18};
      if (side_of(input.plan.zones[0].polygon, p) != Side::kInside) continue;
      input.add(p, 50 + random() % 100);
      total += input.weights.back();
    }
    const ByteCount limit = std::max<ByteCount>(total / (2 + random() % 8), 150);
    SCOPED_TRACE("round " + std::to_string(round));
    const SplitPlan result = input.split(limit);
    expect_sound(input, result, limit);
    EXPECT_GE(result.plan.zones.size(), 2u);
  }
}

TEST(Split, HoldsForTheHospitalUnderEveryLimit) {
  const ZoneFile file = load_zone_file(ZONEPACK_TEST_DATA "/zones.geojson");
  std::ifstream csv(ZONEPACK_TEST_DATA "/optimised_positions/hospital.csv");
  Case input;
  input.plan = file.plan;
  std::string line;
  std::getline(csv, line);
  std::mt19937 random(9);
  while (std::getline(csv, line)) {
    const std::size_t first = line.find(','), second = line.find(',', first + 1);
    input.add({std::stod(line.substr(first + 1)), std::stod(line.substr(second + 1))},
              30000 + random() % 40000);
  }
  for (const ByteCount limit : {4000000u, 1500000u, 600000u}) {
    SCOPED_TRACE("limit " + std::to_string(limit));
    expect_sound(input, input.split(limit), limit);
  }
  // The robot turned on the spot in R52: 19 signatures within 2 mm.
  const SplitPlan fine = input.split(600000);
  const auto r52 = std::find_if(fine.split.begin(), fine.split.end(),
                                [](const SplitZone& zone) { return zone.name == "R52"; });
  ASSERT_NE(r52, fine.split.end());
  EXPECT_GT(r52->narrow_limit, 600000u);
  const SplitPlan halves = input.split(6000000);
  EXPECT_EQ(halves.plan.zones.size(), 25u);  // only L1, of 191 signatures, is heavier
  ASSERT_EQ(halves.split.size(), 1u);
  EXPECT_EQ(halves.split[0].name, "L1");
  EXPECT_EQ(halves.split[0].narrow_limit, 0u);
}

}  // namespace
}  // namespace zonepack::packer
