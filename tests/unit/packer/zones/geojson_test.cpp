// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/geojson.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "geojson_text.hpp"

namespace zonepack::packer {
namespace {

using ::testing::HasSubstr;

TEST(Geojson, NamesTheLineOfASyntaxError) {
  const ZoneFile file =
      parse_zone_file("{\n\"type\": \"FeatureCollection\",\n\"features\": [,]\n}");
  ASSERT_EQ(file.findings.faults.size(), 1u);
  EXPECT_EQ(file.findings.faults[0].line, 3u);
  EXPECT_THAT(file.findings.faults[0].message, HasSubstr("not valid JSON"));
}

TEST(Geojson, RefusesNumbersThatAreNotFinite) {
  for (const char* number : {"NaN", "Infinity", "-Infinity", "1e999", "0x10", "1,5e"}) {
    const ZoneFile file =
        parse({zone("A", std::string("[[0,0],[4,0],[4,") + number + "],[0,4],[0,0]]")});
    ASSERT_EQ(file.findings.faults.size(), 1u) << number;
    EXPECT_EQ(file.findings.faults[0].line, 2u) << number;
  }
}

TEST(Geojson, RefusesAKeyThatStandsTwice) {
  const ZoneFile file = parse({kLeft, zone("B", "[[4,0],[8,0],[8,3],[4,0]]", R"(, "name": "C")")});
  ASSERT_EQ(file.findings.faults.size(), 1u);
  EXPECT_EQ(file.findings.faults[0].line, 3u);
  EXPECT_EQ(file.findings.faults[0].feature, 1u);
  EXPECT_THAT(file.findings.faults[0].message, HasSubstr("\"name\" stands twice"));
}

TEST(Geojson, RefusesWhatIsNotAFeatureCollection) {
  for (const char* text :
       {"[]", "7", "{}", R"({"type": "Feature"})", R"({"type": 3})",
        R"({"type": "FeatureCollection"})", R"({"type": "FeatureCollection", "features": {}})",
        R"({"type": "FeatureCollection", "features": []})",
        R"({"type": "FeatureCollection", "features": [3]})",
        R"({"type": "FeatureCollection", "features": [{"type": "Point"}]})", "", "\xff"}) {
    EXPECT_EQ(parse_zone_file(text).findings.faults.size(), 1u) << text;
  }
}

}  // namespace
}  // namespace zonepack::packer
