// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/zone_checks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "geojson_text.hpp"

namespace zonepack::packer {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(ZoneChecks, NamesTheCrossingEdgesAndThePoint) {
  const ZoneFile file = parse({zone("A", "[[0,0],[4,4],[4,0],[0,4],[0,0]]")});
  ASSERT_EQ(file.findings.faults.size(), 1u);
  EXPECT_EQ(file.findings.faults[0].name, "A");
  EXPECT_EQ(file.findings.faults[0].line, 2u);
  EXPECT_EQ(
      file.findings.faults[0].message,
      "zone 'A' (feature 0) crosses itself: in its outline, edge 0 (0, 0)-(4, 4) meets edge 2 "
      "(4, 0)-(0, 4) at (2, 2); put its vertices in order or delete the wrong one");
}

TEST(ZoneChecks, RefusesAZoneWithoutArea) {
  EXPECT_THAT(faults_of({zone("A", "[[0,0],[4,4],[2,2],[0,0]]"), box("B", 5, 0, 9, 4)}),
              ElementsAre(AllOf(HasSubstr("'A'"), HasSubstr("has no area"))));
}

TEST(ZoneChecks, SuspectsDegrees) {
  // A building of 100 m near Seoul in degrees.
  EXPECT_THAT(
      faults_of({zone("A", "[[127.05,37.5],[127.051,37.5],[127.051,37.501],[127.05,37.5]]")}),
      Contains(HasSubstr("look like degrees")));
  EXPECT_THAT(faults_of({kLeft}), IsEmpty());
}

TEST(ZoneChecks, RefusesAHoleOutsideItsZone) {
  const std::string outer = "[[0,0],[4,0],[4,4],[0,4],[0,0]]";
  EXPECT_THAT(faults_of({zone("A", outer + ",[[5,1],[6,1],[6,2],[5,1]]")}),
              ElementsAre(AllOf(HasSubstr("'A'"), HasSubstr("hole outside its outline"))));
  EXPECT_THAT(faults_of({zone("A", outer + ",[[3,1],[5,1],[5,2],[3,1]]")}),
              ElementsAre(HasSubstr("hole outside its outline")));
  EXPECT_THAT(
      faults_of({zone("A", outer + ",[[1,1],[3,1],[3,3],[1,1]],[[2,1],[3.5,1],[3,3],[2,1]]")}),
      ElementsAre(HasSubstr("holes that overlap")));
  EXPECT_THAT(faults_of({zone("A", outer + ",[[1,1],[3,3],[3,1],[1,3],[1,1]]")}),
              ElementsAre(AllOf(HasSubstr("crosses itself"), HasSubstr("hole 1"))));
  EXPECT_THAT(faults_of({zone("A", outer + "," + outer)}),
              ElementsAre(HasSubstr("holes take all")));
}

TEST(ZoneChecks, RefusesAnOverlapOfMoreThanOnePercentAndSaysHowMuch) {
  // B is 4 x 3 = 12 m2; moved 0.1 m into A they share 0.3 m2 = 2.5 %.
  EXPECT_THAT(faults_of({kLeft, box("B", 3.9, 0, 7.9, 3), kDoor}),
              ElementsAre(AllOf(HasSubstr("'A' and 'B' overlap by 0.3 m2"), HasSubstr("2.5 %"))));
  // 0.03 m: 0.75 %.
  EXPECT_THAT(faults_of({kLeft, box("B", 3.97, 0, 7.97, 3), kDoor}), IsEmpty());
}

TEST(ZoneChecks, MeasuresTheOverlapAgainstTheSmallerZone) {
  // A closet of 1 x 1 m wholly inside a hall of 40 x 30 m is 0.08 % of the hall but all of the
  // closet.
  EXPECT_THAT(faults_of({box("hall", 0, 0, 40, 30), box("closet", 5, 5, 6, 6)}),
              ElementsAre(HasSubstr("100 % of 'closet'")));
}

TEST(ZoneChecks, LetsZonesOfDifferentHeightsOverlap) {
  EXPECT_THAT(faults_of({box("A", 0, 0, 4, 3, R"(, "z_min": 0, "z_max": 3)"),
                         box("B", 0, 0, 4, 3, R"(, "z_min": 3, "z_max": 6)")}),
              IsEmpty());
  EXPECT_THAT(faults_of({box("A", 0, 0, 4, 3, R"(, "z_min": 0, "z_max": 3)"),
                         box("B", 0, 0, 4, 3, R"(, "z_min": 2.9, "z_max": 6)")}),
              ElementsAre(HasSubstr("overlap")));
  EXPECT_THAT(faults_of({box("A", 0, 0, 4, 3, R"(, "z_min": 4, "z_max": 3)")}),
              ElementsAre(HasSubstr("z_min 4, not below its z_max 3")));
  EXPECT_THAT(faults_of({box("A", 0, 0, 4, 3, R"(, "z_min": "low")")}),
              ElementsAre(HasSubstr("z_min that is not a number")));
}

TEST(ZoneChecks, RefusesADuplicateName) {
  EXPECT_THAT(faults_of({kLeft, box("A", 4, 0, 8, 3)}),
              ElementsAre(AllOf(HasSubstr("zone name 'A' (feature 1)"), HasSubstr("feature 0"))));
  EXPECT_THAT(faults_of({kLeft, kRight, kDoor, kDoor}),
              ElementsAre(AllOf(HasSubstr("portal 'P1' (feature 3)"), HasSubstr("feature 2"))));
}

}  // namespace
}  // namespace zonepack::packer
