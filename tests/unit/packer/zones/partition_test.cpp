// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/partition.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <random>
#include <stdexcept>
#include <string>

#include "packer/zones/zone_file.hpp"

namespace zonepack::packer {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

PlannedZone room(const std::string& name, double x0, double y0, double x1, double y1) {
  PlannedZone zone;
  zone.name = name;
  zone.polygon.outer = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
  return zone;
}

std::vector<std::uint32_t> zones_of(const std::vector<PlannedZone>& zones,
                                    const std::vector<Point2>& points) {
  std::vector<SignaturePlace> places;
  for (const Point2 p : points) places.push_back({1, p, 0});
  return partition(zones, places, OrphanPolicy::kDrop).zone_of;
}

constexpr std::uint32_t kNone = Partition::kNone;

TEST(Partition, PutsASignatureIntoTheZoneThatHoldsIt) {
  EXPECT_THAT(zones_of({room("A", 0, 0, 4, 3), room("B", 4, 0, 8, 3)}, {{1, 1}, {5, 1}, {9, 1}}),
              ElementsAre(0, 1, kNone));
}

TEST(Partition, GivesABorderPointToTheFirstName) {
  EXPECT_THAT(zones_of({room("A", 4, 0, 8, 3), room("B", 0, 0, 4, 3)}, {{4, 1}, {4, 0}}),
              ElementsAre(0, 0));
  // The corner of four rooms.
  EXPECT_THAT(zones_of({room("A", 4, 3, 8, 6), room("B", 0, 0, 4, 3), room("C", 4, 0, 8, 3),
                        room("D", 0, 3, 4, 6)},
                       {{4, 3}}),
              ElementsAre(0));
}

TEST(Partition, LetsInsideBeatBorder) {
  // B reaches 1 cm into A; A's border is inside B and goes to B although A sorts first.
  EXPECT_THAT(zones_of({room("A", 0, 0, 4, 3), room("B", 3.99, 0, 8, 3)}, {{4, 1}, {3.995, 1}}),
              ElementsAre(1, 0));
}

TEST(Partition, GivesAPointOnAnOuterBorderToItsOnlyZone) {
  const Partition result =
      partition(std::vector{room("A", 0, 0, 4, 3)}, std::vector<SignaturePlace>{{7, {0, 1}, 0}},
                OrphanPolicy::kError);
  EXPECT_THAT(result.zone_of, ElementsAre(0));
  EXPECT_EQ(result.on_border, 1u);
}

TEST(Partition, KeepsPointsInHolesOut) {
  PlannedZone ring = room("A", 0, 0, 9, 9);
  ring.polygon.holes = {{{3, 3}, {3, 6}, {6, 6}, {6, 3}}};
  EXPECT_THAT(zones_of({ring, room("B", 3, 3, 6, 6)}, {{1, 1}, {4, 4}, {3, 4}}),
              ElementsAre(0, 1, 0));
}

TEST(Partition, GivesOrphansToTheNearestZoneAndListsThem) {
  const std::vector zones{room("A", 0, 0, 4, 3), room("B", 6, 0, 8, 3)};
  const Partition result = partition(
      zones, std::vector<SignaturePlace>{{11, {4.5, 1}, 0}, {12, {5.5, 1}, 0}, {13, {5, 1}, 0}},
      OrphanPolicy::kNearest);
  EXPECT_THAT(result.zone_of, ElementsAre(0, 1, 0));  // 13 is 1 m from both: first by name
  EXPECT_THAT(result.signatures, ElementsAre(2, 1));
  ASSERT_EQ(result.orphans.size(), 3u);
  EXPECT_EQ(result.orphans[0].id, 11);
  EXPECT_EQ(result.orphans[0].nearest_zone, 0u);
  EXPECT_DOUBLE_EQ(result.orphans[0].distance_m, 0.5);
  EXPECT_EQ(result.orphans[1].nearest_zone, 1u);
  EXPECT_EQ(result.orphans[1].p_map, (Point2{5.5, 1}));
}

TEST(Partition, DropsOrphansAndStillListsThem) {
  const Partition result =
      partition(std::vector{room("A", 0, 0, 4, 3)},
                std::vector<SignaturePlace>{{11, {5, 1}, 0}, {12, {1, 1}, 0}}, OrphanPolicy::kDrop);
  EXPECT_THAT(result.zone_of, ElementsAre(kNone, 0));
  EXPECT_THAT(result.signatures, ElementsAre(1));
  EXPECT_EQ(result.orphans.size(), 1u);
}

TEST(Partition, RefusesOrphansByIdPositionAndDistance) {
  try {
    partition(std::vector{room("A", 0, 0, 4, 3)}, std::vector<SignaturePlace>{{42, {5.25, 1}, 0}},
              OrphanPolicy::kError);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("1 signature stands in no zone"));
    EXPECT_THAT(error.what(), HasSubstr("signature 42 at (5.25, 1), 1.25 m from zone 'A'"));
    EXPECT_THAT(error.what(), HasSubstr("--orphans nearest"));
  }
}

TEST(Partition, RefusesAPositionThatIsNotANumber) {
  EXPECT_THROW(
      partition(std::vector{room("A", 0, 0, 4, 3)},
                std::vector<SignaturePlace>{{42, {std::nan(""), 1}, 0}}, OrphanPolicy::kDrop),
      std::runtime_error);
}

TEST(Partition, SeparatesFloorsByHeight) {
  PlannedZone ground = room("G", 0, 0, 4, 3), first = room("U", 0, 0, 4, 3);
  ground.z_max_m = 3;
  first.z_min_m = 3;
  first.z_max_m = 6;
  const std::vector<SignaturePlace> places{
      {1, {1, 1}, -0.2}, {2, {1, 1}, 3}, {3, {1, 1}, 5.9}, {4, {1, 1}, 6}};
  const Partition result = partition(std::vector{ground, first}, places, OrphanPolicy::kNearest);
  EXPECT_THAT(result.zone_of, ElementsAre(0, 1, 1, 0));
  ASSERT_EQ(result.orphans.size(), 1u);
  EXPECT_EQ(result.orphans[0].id, 4);
}

TEST(Partition, PrefersZonesOfTheRightHeightForOrphans) {
  PlannedZone ground = room("G", 0, 0, 4, 3), first = room("U", 0, 0, 4, 2);
  PlannedZone west = room("W", 0, 0, 4, 2.4);  // 0.1 m away, on the ground floor
  ground.z_max_m = 3;
  first.z_min_m = 3;
  west.z_max_m = 3;
  const Partition result =
      partition(std::vector{ground, first, west}, std::vector<SignaturePlace>{{1, {1, 2.5}, 4}},
                OrphanPolicy::kNearest);
  EXPECT_THAT(result.zone_of, ElementsAre(1));
  EXPECT_DOUBLE_EQ(result.orphans.at(0).distance_m, 0.5);
}

TEST(Partition, DoesNotDependOnTheOrderOfSignatures) {
  const ZoneFile file = load_zone_file(ZONEPACK_TEST_DATA "/zones.geojson");
  std::mt19937 random(3);
  std::uniform_real_distribution<double> x(-13, 13), y(-36, 22);
  std::vector<SignaturePlace> places;
  for (int id = 1; id <= 500; ++id) places.push_back({id, {x(random), y(random)}, 0});
  const Partition before = partition(file.plan.zones, places, OrphanPolicy::kNearest);
  std::reverse(places.begin(), places.end());
  Partition after = partition(file.plan.zones, places, OrphanPolicy::kNearest);
  std::reverse(after.zone_of.begin(), after.zone_of.end());
  EXPECT_EQ(before.zone_of, after.zone_of);
}

std::map<std::string, std::size_t> counts_of(const std::string& csv_name) {
  std::ifstream csv(ZONEPACK_TEST_DATA "/optimised_positions/" + csv_name);
  std::vector<SignaturePlace> places;
  std::string line;
  std::getline(csv, line);
  while (std::getline(csv, line)) {
    SignaturePlace place;
    const std::size_t first = line.find(','), second = line.find(',', first + 1);
    place.id = std::stoi(line);
    place.p_map = {std::stod(line.substr(first + 1)), std::stod(line.substr(second + 1))};
    places.push_back(place);
  }
  const ZoneFile file = load_zone_file(ZONEPACK_TEST_DATA "/zones.geojson");
  const Partition result = partition(file.plan.zones, places, OrphanPolicy::kError);
  std::map<std::string, std::size_t> counts;
  for (std::size_t i = 0; i < file.plan.zones.size(); ++i) {
    counts[file.plan.zones[i].name] = result.signatures[i];
  }
  return counts;
}

TEST(Partition, CountsTheSmallHospitalAsPublished) {
  EXPECT_EQ(counts_of("hospital-small.csv"),
            (std::map<std::string, std::size_t>{
                {"C1", 9},  {"C2", 10}, {"C3", 18}, {"H1", 16}, {"H2", 7},  {"H3", 11},
                {"H4", 3},  {"H5", 2},  {"L1", 31}, {"L2", 5},  {"R11", 8}, {"R12", 8},
                {"R13", 4}, {"R21", 9}, {"R22", 9}, {"R23", 8}, {"R31", 4}, {"R32", 4},
                {"R41", 3}, {"R42", 3}, {"R43", 3}, {"R44", 2}, {"R51", 4}, {"R52", 4}}));
}

TEST(Partition, CountsTheHospitalAsPublished) {
  // Signature 607 stands 7 cm from the border of C2 and R22, on C2's side by its optimised pose.
  EXPECT_EQ(counts_of("hospital.csv"),
            (std::map<std::string, std::size_t>{
                {"C1", 57},  {"C2", 62},  {"C3", 96},  {"H1", 89},  {"H2", 44},  {"H3", 69},
                {"H4", 14},  {"H5", 14},  {"L1", 191}, {"L2", 33},  {"R11", 49}, {"R12", 50},
                {"R13", 23}, {"R21", 53}, {"R22", 49}, {"R23", 52}, {"R31", 24}, {"R32", 24},
                {"R41", 17}, {"R42", 16}, {"R43", 17}, {"R44", 11}, {"R51", 19}, {"R52", 22}}));
}

}  // namespace
}  // namespace zonepack::packer
