// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/zone_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "geojson_text.hpp"
#include "packer/zones/plane.hpp"

namespace zonepack::packer {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

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
  const std::string path =
      ::testing::TempDir() + "two_faults_" + std::to_string(::getpid()) + ".geojson";
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
