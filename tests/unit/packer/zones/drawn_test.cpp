// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/drawn.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "geojson_text.hpp"

namespace zonepack::packer {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(DrawnZones, RefusesTooFewVertices) {
  EXPECT_THAT(faults_of({zone("A", "[[0,0],[4,0],[0,0]]")}),
              ElementsAre(HasSubstr("an outline of 2 vertices; at least 3")));
  EXPECT_THAT(faults_of({zone("A", "[]")}), ElementsAre(HasSubstr("0 vertices")));
  EXPECT_THAT(faults_of({zone("A", "")}), ElementsAre(HasSubstr("without coordinates")));
}

TEST(DrawnZones, RefusesAnOpenRing) {
  EXPECT_THAT(faults_of({zone("A", "[[0,0],[4,0],[4,4],[0,4]]")}),
              ElementsAre(AllOf(HasSubstr("'A'"), HasSubstr("open outline"),
                                HasSubstr("repeat the first position"))));
}

TEST(DrawnZones, RefusesCoordinatesThatAreNoMetres) {
  EXPECT_THAT(faults_of({zone("A", "[[0,0],[2e6,0],[4,4],[0,0]]")}),
              ElementsAre(AllOf(HasSubstr("'A'"), HasSubstr("beyond 1000 km"))));
  EXPECT_THAT(faults_of({zone("A", R"([[0,0],["4",0],[4,4],[0,0]])")}),
              ElementsAre(AllOf(HasSubstr("position 1"), HasSubstr("expected [x, y]"))));
  EXPECT_THAT(faults_of({zone("A", "[[0,0],[4],[4,4],[0,0]]")}),
              ElementsAre(HasSubstr("position 1")));
}

TEST(DrawnZones, RefusesNamesThatAreMissingOrUnfit) {
  EXPECT_THAT(faults_of({box("", 0, 0, 4, 3)}),
              ElementsAre(HasSubstr("needs a property \"name\"")));
  EXPECT_THAT(faults_of({box("a/b", 0, 0, 4, 3)}),
              ElementsAre(HasSubstr("unfit name: it holds /")));
  EXPECT_THAT(faults_of({box("a\\u0007", 0, 0, 4, 3)}),
              ElementsAre(HasSubstr("control character")));
}

TEST(DrawnZones, KnowsWhichNamesAreFit) {
  EXPECT_EQ(find_name_problem("R11"), std::nullopt);
  EXPECT_EQ(find_name_problem("Chirurgie Süd, 2. OG (links)"), std::nullopt);
  EXPECT_EQ(find_name_problem("手術室"), std::nullopt);
  EXPECT_EQ(find_name_problem(std::string(64, 'x')), std::nullopt);
  for (const std::string& name :
       {std::string(65, 'x'), std::string(""), std::string(".."), std::string(" a"),
        std::string("a "), std::string("a\\b"), std::string("a\"b"), std::string("a\nb"),
        std::string("a\0b", 3), std::string("a\x7f"), std::string("a\xC2\x85")}) {
    EXPECT_NE(find_name_problem(name), std::nullopt) << name;
  }
}

TEST(DrawnZones, RefusesMultiPolygonsByName) {
  const std::string multi = R"({"type": "Feature", "properties": {"name": "M"}, "geometry":
      {"type": "MultiPolygon", "coordinates": [[[[0,0],[1,0],[1,1],[0,0]]], [[[2,0],[3,0],[3,1],[2,0]]]]}})";
  EXPECT_THAT(faults_of({kLeft, multi}),
              ElementsAre(AllOf(HasSubstr("'M'"), HasSubstr("MultiPolygon of 2 parts"),
                                HasSubstr("split it"))));
  EXPECT_THAT(faults_of({kLeft, R"({"type": "Feature", "properties": null, "geometry": null})"}),
              ElementsAre(HasSubstr("has no geometry")));
}

// As QGIS exports every layer.
TEST(DrawnZones, ReadsMultiGeometriesOfOnePart) {
  const auto multi = [](std::string feature, const std::string& type) {
    const std::string key = "\"coordinates\": ";
    const std::size_t from = feature.find(key) + key.size();
    const std::size_t to = feature.rfind("}}");
    feature = feature.substr(0, from) + "[" + feature.substr(from, to - from) + "]}}";
    return feature.replace(feature.find("\"" + type), 1, "\"Multi");
  };
  const ZoneFile plain = parse({kLeft, kRight, kDoor});
  const ZoneFile file =
      parse({multi(kLeft, "Polygon"), multi(kRight, "Polygon"), multi(kDoor, "LineString")});
  EXPECT_THAT(messages(file.findings.faults), IsEmpty());
  ASSERT_EQ(file.plan.zones.size(), 2u);
  EXPECT_EQ(file.plan.zones[0].polygon.outer, plain.plan.zones[0].polygon.outer);
  ASSERT_EQ(file.plan.portals.size(), 1u);
  EXPECT_EQ(file.plan.portals[0].name, "P1");
}

// 1e-5 degrees are 1.11 m of EPSG:3857.
TEST(DrawnZones, DegreesAreCalledDegreesAndShownInFull) {
  EXPECT_THAT(
      faults_of({zone("A", "[[1e-5,2e-5],[4e-5,2e-5],[4e-5,3e-5],[1e-5,2e-5]]"),
                 zone("B", "[[1e-5,3e-5],[4e-5,3e-5],[4e-5,5e-5],[1e-5,3e-5]]")}),
      ElementsAre(AllOf(HasSubstr("between (1e-05, 2e-05) and (4e-05, 5e-05)"),
                        HasSubstr("(1.11, 2.23) to (4.45, 5.57)"), HasSubstr("EPSG:3857"))));
  EXPECT_THAT(faults_of({zone("A", "[[8.54,47.37],[8.541,47.37],[8.541,47.371],[8.54,47.37]]")}),
              ElementsAre(HasSubstr("look like degrees")));
}

TEST(DrawnZones, RefusesPropertiesOfTheWrongKind) {
  EXPECT_THAT(faults_of({zone("A", "[[0,0],[4,0],[4,4],[0,0]]", R"(, "label": ["x"])")}),
              ElementsAre(HasSubstr("label that is not text")));
}

}  // namespace
}  // namespace zonepack::packer
