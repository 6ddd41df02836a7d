// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/portals.hpp"

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

TEST(Portals, ReadsPortalsByNameByIdOrWithoutEither) {
  const std::string by_id = R"({"type": "Feature", "id": "D7", "properties": {"portal": true,
      "zones": ["A", "B"]}, "geometry": {"type": "LineString", "coordinates": [[4,0],[4,0.5]]}})";
  const std::string nameless = R"({"type": "Feature", "properties": {"portal": true,
      "zones": ["B", "A"]}, "geometry": {"type": "LineString", "coordinates": [[4,2.5],[4,3]]}})";
  const ZoneFile file = parse({kRight, kLeft, kDoor, by_id, nameless});
  EXPECT_THAT(messages(file.findings.faults), IsEmpty());
  EXPECT_FALSE(file.plan.portals_found);
  EXPECT_THAT(
      file.plan.portals,
      ElementsAre(
          PlannedPortal{.name = "B-A", .zone_a = 1, .zone_b = 0, .segment = {{4, 2.5}, {4, 3}}},
          PlannedPortal{.name = "D7", .zone_a = 0, .zone_b = 1, .segment = {{4, 0}, {4, 0.5}}},
          PlannedPortal{.name = "P1", .zone_a = 0, .zone_b = 1, .segment = {{4, 1}, {4, 2}}}));
}

TEST(Portals, MovesPortalEndsOntoTheSharedBorder) {
  const ZoneFile file = parse({kLeft, kRight, portal("P", "A", "B", "[[4.05,1],[3.92,2]]")});
  EXPECT_THAT(messages(file.findings.faults), IsEmpty());
  EXPECT_EQ(file.plan.portals.at(0).segment.p, (Point2{4, 1}));
  EXPECT_EQ(file.plan.portals.at(0).segment.q, (Point2{4, 2}));
}

TEST(Portals, MovesPortalsMidwayBetweenOutlinesThatLieApart) {
  // Outlines at x = 4 and x = 4.16: the border is x = 4.08, and (4, 1) stands 0.08 off it.
  const ZoneFile file =
      parse({kLeft, box("B", 4.16, 0, 8, 3), portal("P", "A", "B", "[[4,1],[4.1,2]]")});
  EXPECT_THAT(messages(file.findings.faults), IsEmpty());
  EXPECT_DOUBLE_EQ(file.plan.portals.at(0).segment.p.x_m, 4.08);
  EXPECT_DOUBLE_EQ(file.plan.portals.at(0).segment.q.x_m, 4.08);
}

TEST(Portals, KeepsAPortalOnItsBorderNearACorner) {
  // (3.97, 0.02) is nearer to A's lower edge than to the border that it shares with B.
  const ZoneFile file = parse({kLeft, kRight, portal("P", "A", "B", "[[3.97,0.02],[3.97,1]]")});
  EXPECT_EQ(file.plan.portals.at(0).segment.p.x_m, 4);
  EXPECT_DOUBLE_EQ(file.plan.portals.at(0).segment.p.y_m, 0.02);
}

TEST(Portals, FindsPortalsAtSharedBordersWhenNoneAreDrawn) {
  // C lies above both: 4 m of border with each; D touches C's corner only; E shares 0.2 m with A.
  const ZoneFile file =
      parse({kLeft, kRight, box("C", 0, 3, 8, 5), box("D", 8, 5, 9, 6), box("E", -1, 2.8, 0, 3)});
  EXPECT_THAT(messages(file.findings.faults), IsEmpty());
  EXPECT_TRUE(file.plan.portals_found);
  EXPECT_THAT(
      file.plan.portals,
      ElementsAre(
          PlannedPortal{.name = "A-B", .zone_a = 0, .zone_b = 1, .segment = {{4, 0}, {4, 3}}},
          PlannedPortal{.name = "A-C", .zone_a = 0, .zone_b = 2, .segment = {{4, 3}, {0, 3}}},
          PlannedPortal{.name = "B-C", .zone_a = 1, .zone_b = 2, .segment = {{8, 3}, {4, 3}}}));
  EXPECT_THAT(messages(file.findings.warnings),
              ElementsAre(AllOf(HasSubstr("'D'"), HasSubstr("unreachable")),
                          AllOf(HasSubstr("'E'"), HasSubstr("unreachable"))));
}

TEST(Portals, FindsOnePortalForEachSeparatePieceOfBorder) {
  // A has a notch at y 1...2, where it keeps 1 m away from B.
  const ZoneFile file =
      parse({zone("A", "[[0,0],[4,0],[4,1],[3,1],[3,2],[4,2],[4,3],[0,3],[0,0]]"), kRight});
  EXPECT_THAT(
      file.plan.portals,
      ElementsAre(
          PlannedPortal{.name = "A-B", .zone_a = 0, .zone_b = 1, .segment = {{4, 0}, {4, 1}}},
          PlannedPortal{.name = "A-B.2", .zone_a = 0, .zone_b = 1, .segment = {{4, 2}, {4, 3}}}));
}

TEST(Portals, RefusesThirteenOfTheHospitalsPortalsWithoutSnap) {
  const ZoneFile file = check_zone_file(ZONEPACK_TEST_DATA "/zones.geojson", 0.02);
  EXPECT_EQ(file.findings.faults.size(), 13u);
  EXPECT_THAT(messages(file.findings.faults),
              Contains(AllOf(HasSubstr("portal 'P02'"), HasSubstr("0.05 m off the border"),
                             HasSubstr("'L1' and 'H1'"), HasSubstr("--snap"))));
}

TEST(Portals, RefusesUnknownPortalZones) {
  EXPECT_THAT(faults_of({kLeft, kRight, portal("P1", "A", "X9", "[[4,1],[4,2]]")}),
              ElementsAre(AllOf(HasSubstr("portal 'P1' (feature 2)"), HasSubstr("'X9'"))));
  EXPECT_THAT(faults_of({kLeft, kRight, portal("P1", "A", "b", "[[4,1],[4,2]]")}),
              ElementsAre(HasSubstr("is it 'B'?")));
}

TEST(Portals, RefusesAPortalOfAZoneWithItself) {
  EXPECT_THAT(faults_of({kLeft, portal("P1", "A", "A", "[[4,1],[4,2]]")}),
              ElementsAre(HasSubstr("joins zone 'A' to itself")));
}

TEST(Portals, RefusesAPortalOffTheBorder) {
  EXPECT_THAT(faults_of({kLeft, kRight, portal("P1", "A", "B", "[[4.5,1],[4.5,2]]")}),
              ElementsAre(AllOf(HasSubstr("portal 'P1'"), HasSubstr("0.5 m off the border"),
                                HasSubstr("'A' and 'B'"))));
  EXPECT_THAT(faults_of({kLeft, kRight, portal("P1", "A", "B", "[[4.5,1],[4.5,2]]")}, 0.6),
              IsEmpty());
  // One end only.
  EXPECT_THAT(faults_of({kLeft, kRight, portal("P1", "A", "B", "[[4,1],[4,3.2]]")}),
              ElementsAre(HasSubstr("its end (4, 3.2) stands 0.2 m")));
}

TEST(Portals, RefusesAPortalOfZonesThatDoNotMeet) {
  EXPECT_THAT(faults_of({kLeft, box("B", 5, 0, 8, 3), portal("P1", "A", "B", "[[4,1],[4,2]]")}),
              ElementsAre(AllOf(HasSubstr("'A' and 'B'"), HasSubstr("share no border"))));
}

TEST(Portals, RefusesAPortalWithoutLength) {
  EXPECT_THAT(faults_of({kLeft, kRight, portal("P1", "A", "B", "[[4,1],[4,1]]")}),
              ElementsAre(HasSubstr("has no length")));
  EXPECT_THAT(faults_of({kLeft, kRight, portal("P1", "A", "B", "[[3.95,1],[4.05,1]]")}),
              ElementsAre(HasSubstr("stands across the border")));
}

TEST(Portals, RefusesPortalsThatAreNotOneStraightLink) {
  EXPECT_THAT(faults_of({kLeft, kRight, portal("P1", "A", "B", "[[4,1],[4,1.5],[4,2]]")}),
              ElementsAre(HasSubstr("3 positions; a portal is one straight line")));
  const auto with = [](const std::string& properties) {
    return R"({"type": "Feature", "properties": {)" + properties +
           R"(}, "geometry": {"type": "LineString", "coordinates": [[4,1],[4,2]]}})";
  };
  for (const char* zones : {R"("A")", R"(["A"])", R"(["A", "B", "C"])", R"(["A", 2])", "null"}) {
    EXPECT_THAT(
        faults_of({kLeft, kRight, with(R"("portal": true, "zones": )" + std::string(zones))}),
        ElementsAre(HasSubstr("needs a property \"zones\"")))
        << zones;
  }
  EXPECT_THAT(faults_of({kLeft, kRight, with(R"("zones": ["A", "B"])")}),
              ElementsAre(HasSubstr("without \"portal\": true")));
  EXPECT_THAT(faults_of({kLeft, kRight, with(R"("portal": "yes", "zones": ["A", "B"])")}),
              ElementsAre(HasSubstr("expected true")));
}

}  // namespace
}  // namespace zonepack::packer
