// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/zone_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "geojson_text.hpp"
#include "packer/zones/plane.hpp"

namespace zonepack::packer {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// Two rooms side by side, sharing x = 4, y 0...3.
const std::string kLeft = box("A", 0, 0, 4, 3);
const std::string kRight = box("B", 4, 0, 8, 3);
const std::string kDoor = portal("P1", "A", "B", "[[4,1],[4,2]]");

std::vector<std::string> faults_of(const std::vector<std::string>& features,
                                   double snap_m = kDefaultSnap_m) {
  return messages(parse(features, snap_m).findings.faults);
}

TEST(ZoneFile, ReadsZonesSortedByNameWithTheirProperties) {
  const ZoneFile file = parse({zone("b", "[[4,0],[8,0],[8,3],[4,3],[4,0]]",
                                    R"(, "label": "ward B", "layer": "rooms", "floor": 2,
                                       "z_min": 3, "z_max": 6.5, "area": [1, {"x": 2}])"),
                               box("a", 0, 0, 4, 3), box("C", 0, 3, 8, 4)});
  EXPECT_THAT(messages(file.findings.faults), IsEmpty());
  ASSERT_EQ(file.plan.zones.size(), 3u);
  EXPECT_EQ(file.plan.zones[0].name, "C");  // byte order: capitals first
  EXPECT_EQ(file.plan.zones[1].name, "a");
  const PlannedZone& b = file.plan.zones[2];
  EXPECT_EQ(b.name, "b");
  EXPECT_EQ(b.zone_type, "room");
  EXPECT_EQ(b.label, "ward B");
  EXPECT_EQ(b.layer, "rooms");
  EXPECT_EQ(b.floor, "2");
  EXPECT_EQ(b.z_min_m, 3);
  EXPECT_EQ(b.z_max_m, 6.5);
  EXPECT_EQ(b.polygon.outer, (Ring{{4, 0}, {8, 0}, {8, 3}, {4, 3}}));
}

TEST(ZoneFile, ReadsHolesThirdCoordinatesAndEitherOrientation) {
  const ZoneFile file = parse(
      {zone("A", "[[0,0,7],[0,4,7],[4,4,7],[4,0,7],[0,0,7]],[[1,1],[2,1],[2,2],[1,2],[1,1]]")});
  EXPECT_THAT(messages(file.findings.faults), IsEmpty());
  const Polygon& polygon = file.plan.zones.at(0).polygon;
  EXPECT_EQ(area_m2(polygon), 15);
  EXPECT_GT(twice_signed_area(polygon.outer), 0);
  EXPECT_LT(twice_signed_area(polygon.holes.at(0)), 0);
}

TEST(ZoneFile, DropsVerticesThatStandTwice) {
  const ZoneFile file = parse({zone("A", "[[0,0],[4,0],[4,0],[4,4],[0,4],[0,0],[0,0]]")});
  EXPECT_THAT(messages(file.findings.faults), IsEmpty());
  EXPECT_EQ(file.plan.zones.at(0).polygon.outer.size(), 4u);
}

TEST(ZoneFile, ReadsPortalsByNameByIdOrWithoutEither) {
  const std::string by_id = R"({"type": "Feature", "id": "D7", "properties": {"portal": true,
      "zones": ["A", "B"]}, "geometry": {"type": "LineString", "coordinates": [[4,0],[4,0.5]]}})";
  const std::string nameless = R"({"type": "Feature", "properties": {"portal": true,
      "zones": ["B", "A"]}, "geometry": {"type": "LineString", "coordinates": [[4,2.5],[4,3]]}})";
  const ZoneFile file = parse({kRight, kLeft, kDoor, by_id, nameless});
  EXPECT_THAT(messages(file.findings.faults), IsEmpty());
  EXPECT_FALSE(file.plan.portals_found);
  EXPECT_THAT(file.plan.portals, ElementsAre(PlannedPortal{"B-A", 1, 0, {{4, 2.5}, {4, 3}}},
                                             PlannedPortal{"D7", 0, 1, {{4, 0}, {4, 0.5}}},
                                             PlannedPortal{"P1", 0, 1, {{4, 1}, {4, 2}}}));
}

TEST(ZoneFile, MovesPortalEndsOntoTheSharedBorder) {
  const ZoneFile file = parse({kLeft, kRight, portal("P", "A", "B", "[[4.05,1],[3.92,2]]")});
  EXPECT_THAT(messages(file.findings.faults), IsEmpty());
  EXPECT_EQ(file.plan.portals.at(0).segment.p, (Point2{4, 1}));
  EXPECT_EQ(file.plan.portals.at(0).segment.q, (Point2{4, 2}));
}

TEST(ZoneFile, MovesPortalsMidwayBetweenOutlinesThatLieApart) {
  // Outlines at x = 4 and x = 4.16: the border is x = 4.08, and (4, 1) stands 0.08 off it.
  const ZoneFile file =
      parse({kLeft, box("B", 4.16, 0, 8, 3), portal("P", "A", "B", "[[4,1],[4.1,2]]")});
  EXPECT_THAT(messages(file.findings.faults), IsEmpty());
  EXPECT_DOUBLE_EQ(file.plan.portals.at(0).segment.p.x_m, 4.08);
  EXPECT_DOUBLE_EQ(file.plan.portals.at(0).segment.q.x_m, 4.08);
}

TEST(ZoneFile, KeepsAPortalOnItsBorderNearACorner) {
  // (3.97, 0.02) is nearer to A's lower edge than to the border that it shares with B.
  const ZoneFile file = parse({kLeft, kRight, portal("P", "A", "B", "[[3.97,0.02],[3.97,1]]")});
  EXPECT_EQ(file.plan.portals.at(0).segment.p.x_m, 4);
  EXPECT_DOUBLE_EQ(file.plan.portals.at(0).segment.p.y_m, 0.02);
}

TEST(ZoneFile, FindsPortalsAtSharedBordersWhenNoneAreDrawn) {
  // C lies above both: 4 m of border with each; D touches C's corner only; E shares 0.2 m with A.
  const ZoneFile file =
      parse({kLeft, kRight, box("C", 0, 3, 8, 5), box("D", 8, 5, 9, 6), box("E", -1, 2.8, 0, 3)});
  EXPECT_THAT(messages(file.findings.faults), IsEmpty());
  EXPECT_TRUE(file.plan.portals_found);
  EXPECT_THAT(file.plan.portals, ElementsAre(PlannedPortal{"A-B", 0, 1, {{4, 0}, {4, 3}}},
                                             PlannedPortal{"A-C", 0, 2, {{4, 3}, {0, 3}}},
                                             PlannedPortal{"B-C", 1, 2, {{8, 3}, {4, 3}}}));
  EXPECT_THAT(messages(file.findings.warnings),
              ElementsAre(AllOf(HasSubstr("'D'"), HasSubstr("unreachable")),
                          AllOf(HasSubstr("'E'"), HasSubstr("unreachable"))));
}

TEST(ZoneFile, FindsOnePortalForEachSeparatePieceOfBorder) {
  // A has a notch at y 1...2, where it keeps 1 m away from B.
  const ZoneFile file =
      parse({zone("A", "[[0,0],[4,0],[4,1],[3,1],[3,2],[4,2],[4,3],[0,3],[0,0]]"), kRight});
  EXPECT_THAT(file.plan.portals, ElementsAre(PlannedPortal{"A-B", 0, 1, {{4, 0}, {4, 1}}},
                                             PlannedPortal{"A-B.2", 0, 1, {{4, 2}, {4, 3}}}));
}

TEST(ZoneFile, ReadsTheHospital) {
  const ZoneFile file = load_zone_file(ZONEPACK_TEST_DATA "/zones.geojson");
  EXPECT_THAT(messages(file.findings.warnings), IsEmpty());
  ASSERT_EQ(file.plan.zones.size(), 24u);
  ASSERT_EQ(file.plan.portals.size(), 28u);
  for (const PlannedPortal& portal : file.plan.portals) {
    for (const std::uint32_t zone : {portal.zone_a, portal.zone_b}) {
      for (const Point2 p : {portal.segment.p, portal.segment.q}) {
        EXPECT_LE(distance_to_border_m(file.plan.zones[zone].polygon, p), 1e-12) << portal.name;
      }
    }
  }
  // P02 is drawn at y = 0.05; its zones share y = 0.
  EXPECT_EQ(file.plan.portals[1].name, "P02");
  EXPECT_EQ(file.plan.portals[1].segment.p, (Point2{-6.375, 0}));
  EXPECT_EQ(file.plan.portals[1].segment.q, (Point2{-3.675, 0}));
}

TEST(ZoneFile, RefusesThirteenOfTheHospitalsPortalsWithoutSnap) {
  const ZoneFile file = parse_zone_file(text_of(ZONEPACK_TEST_DATA "/zones.geojson"), 0.02);
  EXPECT_EQ(file.findings.faults.size(), 13u);
  EXPECT_THAT(messages(file.findings.faults),
              Contains(AllOf(HasSubstr("portal 'P02'"), HasSubstr("0.05 m off the border"),
                             HasSubstr("'L1' and 'H1'"), HasSubstr("--snap"))));
}

TEST(ZoneFileFault, NamesTheLineOfASyntaxError) {
  const ZoneFile file =
      parse_zone_file("{\n\"type\": \"FeatureCollection\",\n\"features\": [,]\n}");
  ASSERT_EQ(file.findings.faults.size(), 1u);
  EXPECT_EQ(file.findings.faults[0].line, 3u);
  EXPECT_THAT(file.findings.faults[0].message, HasSubstr("not valid JSON"));
}

TEST(ZoneFileFault, RefusesNumbersThatAreNotFinite) {
  for (const char* number : {"NaN", "Infinity", "-Infinity", "1e999", "0x10", "1,5e"}) {
    const ZoneFile file =
        parse({zone("A", std::string("[[0,0],[4,0],[4,") + number + "],[0,4],[0,0]]")});
    ASSERT_EQ(file.findings.faults.size(), 1u) << number;
    EXPECT_EQ(file.findings.faults[0].line, 2u) << number;
  }
}

TEST(ZoneFileFault, RefusesAKeyThatStandsTwice) {
  const ZoneFile file = parse({kLeft, zone("B", "[[4,0],[8,0],[8,3],[4,0]]", R"(, "name": "C")")});
  ASSERT_EQ(file.findings.faults.size(), 1u);
  EXPECT_EQ(file.findings.faults[0].line, 3u);
  EXPECT_EQ(file.findings.faults[0].feature, 1u);
  EXPECT_THAT(file.findings.faults[0].message, HasSubstr("\"name\" stands twice"));
}

TEST(ZoneFileFault, RefusesWhatIsNotAFeatureCollection) {
  for (const char* text :
       {"[]", "7", "{}", R"({"type": "Feature"})", R"({"type": 3})",
        R"({"type": "FeatureCollection"})", R"({"type": "FeatureCollection", "features": {}})",
        R"({"type": "FeatureCollection", "features": []})",
        R"({"type": "FeatureCollection", "features": [3]})",
        R"({"type": "FeatureCollection", "features": [{"type": "Point"}]})", "", "\xff"}) {
    EXPECT_EQ(parse_zone_file(text).findings.faults.size(), 1u) << text;
  }
}

TEST(ZoneFileFault, NamesTheCrossingEdgesAndThePoint) {
  const ZoneFile file = parse({zone("A", "[[0,0],[4,4],[4,0],[0,4],[0,0]]")});
  ASSERT_EQ(file.findings.faults.size(), 1u);
  EXPECT_EQ(file.findings.faults[0].name, "A");
  EXPECT_EQ(file.findings.faults[0].line, 2u);
  EXPECT_EQ(
      file.findings.faults[0].message,
      "zone 'A' (feature 0) crosses itself: in its outline, edge 0 (0, 0)-(4, 4) meets edge 2 "
      "(4, 0)-(0, 4) at (2, 2); put its vertices in order or delete the wrong one");
}

TEST(ZoneFileFault, RefusesTooFewVertices) {
  EXPECT_THAT(faults_of({zone("A", "[[0,0],[4,0],[0,0]]")}),
              ElementsAre(HasSubstr("an outline of 2 vertices; at least 3")));
  EXPECT_THAT(faults_of({zone("A", "[]")}), ElementsAre(HasSubstr("0 vertices")));
  EXPECT_THAT(faults_of({zone("A", "")}), ElementsAre(HasSubstr("without coordinates")));
}

TEST(ZoneFileFault, RefusesAnOpenRing) {
  EXPECT_THAT(faults_of({zone("A", "[[0,0],[4,0],[4,4],[0,4]]")}),
              ElementsAre(AllOf(HasSubstr("'A'"), HasSubstr("open outline"),
                                HasSubstr("repeat the first position"))));
}

TEST(ZoneFileFault, RefusesAZoneWithoutArea) {
  EXPECT_THAT(faults_of({zone("A", "[[0,0],[4,4],[2,2],[0,0]]"), box("B", 5, 0, 9, 4)}),
              ElementsAre(AllOf(HasSubstr("'A'"), HasSubstr("has no area"))));
}

TEST(ZoneFileFault, RefusesCoordinatesThatAreNoMetres) {
  EXPECT_THAT(faults_of({zone("A", "[[0,0],[2e6,0],[4,4],[0,0]]")}),
              ElementsAre(AllOf(HasSubstr("'A'"), HasSubstr("beyond 1000 km"))));
  EXPECT_THAT(faults_of({zone("A", R"([[0,0],["4",0],[4,4],[0,0]])")}),
              ElementsAre(AllOf(HasSubstr("position 1"), HasSubstr("expected [x, y]"))));
  EXPECT_THAT(faults_of({zone("A", "[[0,0],[4],[4,4],[0,0]]")}),
              ElementsAre(HasSubstr("position 1")));
}

TEST(ZoneFileFault, SuspectsDegrees) {
  // A building of 100 m near Seoul in degrees.
  EXPECT_THAT(
      faults_of({zone("A", "[[127.05,37.5],[127.051,37.5],[127.051,37.501],[127.05,37.5]]")}),
      Contains(HasSubstr("look like degrees")));
  EXPECT_THAT(faults_of({kLeft}), IsEmpty());
}

TEST(ZoneFileFault, RefusesAHoleOutsideItsZone) {
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

TEST(ZoneFileFault, RefusesAnOverlapOfMoreThanOnePercentAndSaysHowMuch) {
  // B is 4 x 3 = 12 m2; moved 0.1 m into A they share 0.3 m2 = 2.5 %.
  EXPECT_THAT(faults_of({kLeft, box("B", 3.9, 0, 7.9, 3), kDoor}),
              ElementsAre(AllOf(HasSubstr("'A' and 'B' overlap by 0.3 m2"), HasSubstr("2.5 %"))));
  // 0.03 m: 0.75 %.
  EXPECT_THAT(faults_of({kLeft, box("B", 3.97, 0, 7.97, 3), kDoor}), IsEmpty());
}

TEST(ZoneFileFault, MeasuresTheOverlapAgainstTheSmallerZone) {
  // A closet of 1 x 1 m wholly inside a hall of 40 x 30 m is 0.08 % of the hall but all of the
  // closet.
  EXPECT_THAT(faults_of({box("hall", 0, 0, 40, 30), box("closet", 5, 5, 6, 6)}),
              ElementsAre(HasSubstr("100 % of 'closet'")));
}

TEST(ZoneFileFault, LetsZonesOfDifferentHeightsOverlap) {
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

TEST(ZoneFileFault, RefusesADuplicateName) {
  EXPECT_THAT(faults_of({kLeft, box("A", 4, 0, 8, 3)}),
              ElementsAre(AllOf(HasSubstr("zone name 'A' (feature 1)"), HasSubstr("feature 0"))));
  EXPECT_THAT(faults_of({kLeft, kRight, kDoor, kDoor}),
              ElementsAre(AllOf(HasSubstr("portal 'P1' (feature 3)"), HasSubstr("feature 2"))));
}

TEST(ZoneFileFault, RefusesNamesThatAreMissingOrUnfit) {
  EXPECT_THAT(faults_of({box("", 0, 0, 4, 3)}),
              ElementsAre(HasSubstr("needs a property \"name\"")));
  EXPECT_THAT(faults_of({box("a/b", 0, 0, 4, 3)}),
              ElementsAre(HasSubstr("unfit name: it holds /")));
  EXPECT_THAT(faults_of({box("a\\u0007", 0, 0, 4, 3)}),
              ElementsAre(HasSubstr("control character")));
}

TEST(ZoneFileFault, KnowsWhichNamesAreFit) {
  EXPECT_EQ(why_unfit_name("R11"), "");
  EXPECT_EQ(why_unfit_name("Chirurgie Süd, 2. OG (links)"), "");
  EXPECT_EQ(why_unfit_name("手術室"), "");
  EXPECT_EQ(why_unfit_name(std::string(64, 'x')), "");
  for (const std::string& name :
       {std::string(65, 'x'), std::string(""), std::string(".."), std::string(" a"),
        std::string("a "), std::string("a\\b"), std::string("a\"b"), std::string("a\nb"),
        std::string("a\0b", 3), std::string("a\x7f"), std::string("a\xC2\x85")}) {
    EXPECT_NE(why_unfit_name(name), "") << name;
  }
}

TEST(ZoneFileFault, RefusesUnknownPortalZones) {
  EXPECT_THAT(faults_of({kLeft, kRight, portal("P1", "A", "X9", "[[4,1],[4,2]]")}),
              ElementsAre(AllOf(HasSubstr("portal 'P1' (feature 2)"), HasSubstr("'X9'"))));
  EXPECT_THAT(faults_of({kLeft, kRight, portal("P1", "A", "b", "[[4,1],[4,2]]")}),
              ElementsAre(HasSubstr("is it 'B'?")));
}

TEST(ZoneFileFault, RefusesAPortalOfAZoneWithItself) {
  EXPECT_THAT(faults_of({kLeft, portal("P1", "A", "A", "[[4,1],[4,2]]")}),
              ElementsAre(HasSubstr("joins zone 'A' to itself")));
}

TEST(ZoneFileFault, RefusesAPortalOffTheBorder) {
  EXPECT_THAT(faults_of({kLeft, kRight, portal("P1", "A", "B", "[[4.5,1],[4.5,2]]")}),
              ElementsAre(AllOf(HasSubstr("portal 'P1'"), HasSubstr("0.5 m off the border"),
                                HasSubstr("'A' and 'B'"))));
  EXPECT_THAT(faults_of({kLeft, kRight, portal("P1", "A", "B", "[[4.5,1],[4.5,2]]")}, 0.6),
              IsEmpty());
  // One end only.
  EXPECT_THAT(faults_of({kLeft, kRight, portal("P1", "A", "B", "[[4,1],[4,3.2]]")}),
              ElementsAre(HasSubstr("its end (4, 3.2) stands 0.2 m")));
}

TEST(ZoneFileFault, RefusesAPortalOfZonesThatDoNotMeet) {
  EXPECT_THAT(faults_of({kLeft, box("B", 5, 0, 8, 3), portal("P1", "A", "B", "[[4,1],[4,2]]")}),
              ElementsAre(AllOf(HasSubstr("'A' and 'B'"), HasSubstr("share no border"))));
}

TEST(ZoneFileFault, RefusesAPortalWithoutLength) {
  EXPECT_THAT(faults_of({kLeft, kRight, portal("P1", "A", "B", "[[4,1],[4,1]]")}),
              ElementsAre(HasSubstr("has no length")));
  EXPECT_THAT(faults_of({kLeft, kRight, portal("P1", "A", "B", "[[3.95,1],[4.05,1]]")}),
              ElementsAre(HasSubstr("stands across the border")));
}

TEST(ZoneFileFault, RefusesPortalsThatAreNotOneStraightLink) {
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

TEST(ZoneFileFault, RefusesMoreVerticesAndPortalsThanTheFormatHolds) {
  std::string comb = "[0,0]";  // 2049 teeth: 4099 vertices
  for (int i = 2048; i >= 0; --i) {
    comb += ",[" + std::to_string(i + 1) + ",1],[" + std::to_string(i) + ".5,2]";
  }
  EXPECT_THAT(faults_of({zone("A", "[" + comb + ",[0,0]]")}),
              ElementsAre(HasSubstr("has 4099 vertices; at most 4096")));
  std::vector<std::string> features{box("A", 0, 0, 300, 1), box("B", 0, 1, 300, 2)};
  for (int i = 0; i < 257; ++i) {
    const std::string x = std::to_string(i);
    features.push_back(portal("P" + x, "A", "B", "[[" + x + ",1],[" + x + ".5,1]]"));
  }
  EXPECT_THAT(faults_of(features), ElementsAre(HasSubstr("zone 'A' has 257 portals, at most 256"),
                                               HasSubstr("zone 'B' has 257 portals")));
}

TEST(ZoneFileFault, RefusesMultiPolygonsByName) {
  const std::string multi = R"({"type": "Feature", "properties": {"name": "M"}, "geometry":
      {"type": "MultiPolygon", "coordinates": [[[[0,0],[1,0],[1,1],[0,0]]]]}})";
  EXPECT_THAT(
      faults_of({kLeft, multi}),
      ElementsAre(AllOf(HasSubstr("'M'"), HasSubstr("MultiPolygon"), HasSubstr("split it"))));
  EXPECT_THAT(faults_of({kLeft, R"({"type": "Feature", "properties": null, "geometry": null})"}),
              ElementsAre(HasSubstr("has no geometry")));
}

TEST(ZoneFileFault, RefusesPropertiesOfTheWrongKind) {
  EXPECT_THAT(faults_of({zone("A", "[[0,0],[4,0],[4,4],[0,0]]", R"(, "label": ["x"])")}),
              ElementsAre(HasSubstr("label that is not text")));
}

TEST(ZoneFileFault, ReportsEveryFaultAtOnce) {
  EXPECT_THAT(
      faults_of({zone("bow", "[[20,0],[24,4],[24,0],[20,4],[20,0]]"), kLeft, box("A", 4, 0, 8, 3),
                 box("over", 1, 1, 3, 2), portal("P1", "A", "Z", "[[4,1],[4,2]]"),
                 portal("P2", "A", "bow", "[[4,1],[4,2]]"),
                 portal("P3", "A", "A", "[[4,1],[4,2]]")}),
      UnorderedElementsAre(HasSubstr("'bow' (feature 0) crosses itself"),
                           HasSubstr("zone name 'A' (feature 2) is taken"),
                           HasSubstr("'A' and 'over' overlap"), HasSubstr("names zone 'Z'"),
                           HasSubstr("joins zone 'A' to itself")));
}

TEST(ZoneFileWarning, NamesZonesThatNoPortalReaches) {
  const ZoneFile file = parse({kLeft, kRight, box("C", 20, 0, 24, 3), kDoor});
  EXPECT_THAT(messages(file.findings.faults), IsEmpty());
  ASSERT_EQ(file.findings.warnings.size(), 1u);
  EXPECT_EQ(file.findings.warnings[0].name, "C");
  EXPECT_EQ(file.findings.warnings[0].line, 4u);
  EXPECT_THAT(file.findings.warnings[0].message, HasSubstr("unreachable"));
}

TEST(ZoneFileWarning, NamesZonesWithoutATypeAndFeaturesLeftOut) {
  const ZoneFile file = parse(
      {R"({"type": "Feature", "properties": {"name": "A", "zone_type": null}, "geometry":
          {"type": "Polygon", "coordinates": [[[0,0],[4,0],[4,3],[0,0]]]}})",
       R"({"type": "Feature", "properties": {}, "geometry": {"type": "Point", "coordinates": [1,1]}})",
       R"({"type": "Feature", "properties": {}, "geometry":
          {"type": "LineString", "coordinates": [[1,1],[2,2]]}})"});
  EXPECT_THAT(messages(file.findings.faults), IsEmpty());
  EXPECT_THAT(
      messages(file.findings.warnings),
      ElementsAre(HasSubstr("zone 'A' (feature 0) has no zone_type"),
                  HasSubstr("is a Point; it is left out"), HasSubstr("is a LineString without")));
}

TEST(ZoneFile, LoadThrowsEveryFaultWithFileAndLine) {
  const std::string path = ::testing::TempDir() + "two_faults_" + std::to_string(::getpid()) + ".geojson";
  std::ofstream(path) << collection(
      {zone("A", "[[0,0],[4,4],[4,0],[0,4],[0,0]]"), box("a/b", 5, 0, 6, 1)});
  try {
    load_zone_file(path);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr(path + ": 2 faults"));
    EXPECT_THAT(error.what(), HasSubstr(path + ":2: zone 'A'"));
    EXPECT_THAT(error.what(), HasSubstr(path + ":3: zone 'a/b'"));
  }
}

TEST(ZoneFile, SaysWhyAFileCannotBeRead) {
  try {
    check_zone_file("/no/such/zones.geojson");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("/no/such/zones.geojson"));
    EXPECT_THAT(error.what(), HasSubstr("No such file"));
  }
}

}  // namespace
}  // namespace zonepack::packer
