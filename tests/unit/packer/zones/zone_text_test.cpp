// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/zone_text.hpp"

#include <gtest/gtest.h>

#include "packer/zones/zone_file.hpp"

namespace zonepack::packer {
namespace {

TEST(ZoneText, IsReadBackAsItWas) {
  ZonePlan plan;
  PlannedZone hall, shed;
  hall.name = "hall";
  hall.zone_type = "lobby";
  hall.label = "the \"large\" one";
  hall.floor = "1";
  hall.z_min_m = -0.5;
  hall.polygon.outer = {{0, 0}, {10, 0}, {10, 5}, {0, 5}};
  hall.polygon.holes = {{{2, 2}, {2, 3}, {3, 3}, {3, 2}}};
  shed.name = "shed";
  shed.zone_type = "closet";
  shed.polygon.outer = {{10, 0}, {12.0001, 0}, {12.0001, 5}, {10, 5}};
  plan.zones = {hall, shed};
  plan.portals = {{"door", 0, 1, {{10, 1}, {10, 2}}}};
  const ZoneFile read = parse_zone_file(zones_geojson(plan));
  EXPECT_TRUE(read.findings.faults.empty());
  EXPECT_TRUE(read.findings.warnings.empty());
  ASSERT_EQ(read.plan.zones.size(), 2u);
  EXPECT_EQ(read.plan.zones[0].name, "hall");
  EXPECT_EQ(read.plan.zones[0].label, hall.label);
  EXPECT_EQ(read.plan.zones[0].floor, "1");
  EXPECT_EQ(read.plan.zones[0].z_min_m, -0.5);
  EXPECT_EQ(read.plan.zones[0].polygon.holes, hall.polygon.holes);
  EXPECT_EQ(read.plan.zones[1].polygon.outer, shed.polygon.outer);
  EXPECT_EQ(read.plan.portals, plan.portals);
}

}  // namespace
}  // namespace zonepack::packer
