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
      {"type": "MultiPolygon", "coordinates": [[[[0,0],[1,0],[1,1],[0,0]]]]}})";
  EXPECT_THAT(
      faults_of({kLeft, multi}),
      ElementsAre(AllOf(HasSubstr("'M'"), HasSubstr("MultiPolygon"), HasSubstr("split it"))));
  EXPECT_THAT(faults_of({kLeft, R"({"type": "Feature", "properties": null, "geometry": null})"}),
              ElementsAre(HasSubstr("has no geometry")));
}

TEST(DrawnZones, RefusesPropertiesOfTheWrongKind) {
  EXPECT_THAT(faults_of({zone("A", "[[0,0],[4,0],[4,4],[0,0]]", R"(, "label": ["x"])")}),
              ElementsAre(HasSubstr("label that is not text")));
}

}  // namespace
}  // namespace zonepack::packer
