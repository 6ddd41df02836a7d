// SPDX-License-Identifier: Apache-2.0
// Whatever a file contains, reading it ends in findings and never in a crash.
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "geojson_text.hpp"

namespace zonepack::packer {
namespace {

std::string sample() {
  return collection({box("A", 0, 0, 4, 3), box("B", 4, 0, 8, 3),
                     zone("C", "[[0,3],[8,3],[8,9],[0,9],[0,3]],[[1,4],[2,4],[2,5],[1,5],[1,4]]"),
                     portal("P1", "A", "B", "[[4,1],[4,2]]"),
                     portal("P2", "C", "A", "[[1,3.05],[2,3]]")});
}

TEST(ZoneFileRobustness, ReportsEveryTruncation) {
  const std::string text = sample();
  const std::size_t end = text.find_last_of('}');
  ASSERT_TRUE(parse_zone_file(text).findings.faults.empty());
  for (std::size_t length = 0; length <= end; ++length) {
    ASSERT_EQ(parse_zone_file(text.substr(0, length)).findings.faults.size(), 1u) << length;
  }
}

TEST(ZoneFileRobustness, SurvivesWrongBytes) {
  std::mt19937 random(17);
  std::size_t refused = 0;
  for (int round = 0; round < 4000; ++round) {
    std::string text = sample();
    const int changes = 1 + static_cast<int>(random() % 3);
    for (int i = 0; i < changes; ++i) {
      static constexpr char kTempting[] = "0123456789.-+eE[]{},:\"\\/ntf\n \x80\xff";
      const std::size_t at = random() % text.size();
      text[at] = kTempting[random() % (sizeof kTempting - 1)];
    }
    refused += !parse_zone_file(text).findings.faults.empty();
  }
  EXPECT_GT(refused, 2000u);
}

TEST(ZoneFileRobustness, SurvivesRandomOutlines) {
  std::mt19937 random(23);
  const auto coordinate = [&] { return std::to_string(static_cast<int>(random() % 7)); };
  std::size_t sound = 0;
  for (int round = 0; round < 3000; ++round) {
    std::vector<std::string> features;
    for (const char* name : {"A", "B", "C"}) {
      std::string ring;
      const std::string first = "[" + coordinate() + "," + coordinate() + "]";
      ring = first;
      for (std::size_t i = 2 + random() % 4; i > 0; --i) {
        ring += ",[" + coordinate() + "," + coordinate() + "]";
      }
      features.push_back(zone(name, "[" + ring + "," + first + "]"));
    }
    const ZoneFile file = parse(features);
    sound += file.plan.zones.size();
    for (const PlannedPortal& portal : file.plan.portals) {
      ASSERT_LT(portal.zone_a, file.plan.zones.size());
      ASSERT_LT(portal.zone_b, file.plan.zones.size());
    }
  }
  EXPECT_GT(sound, 1000u);
}

TEST(ZoneFileRobustness, RefusesDeepNestingByLine) {
  const std::string deep = std::string(200000, '[') + std::string(200000, ']');
  for (const std::string& feature :
       {zone("A", deep), zone("A", "[[0,0],[1,0],[1,1],[0,0]]", ", \"x\": " + deep)}) {
    const ZoneFile file = parse({feature});
    ASSERT_EQ(file.findings.faults.size(), 1u);
    EXPECT_EQ(file.findings.faults[0].line, 2u);
    EXPECT_NE(file.findings.faults[0].message.find("levels deep"), std::string::npos);
  }
}

}  // namespace
}  // namespace zonepack::packer
