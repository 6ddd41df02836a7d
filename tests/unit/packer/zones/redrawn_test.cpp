// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/redrawn.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

#include "packer/zones/zone_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string room_text(const std::string& name, double left, double right) {
  const std::string l = std::to_string(left), r = std::to_string(right);
  return R"({"type":"Feature","properties":{"name":")" + name +
         R"(","zone_type":"room"},"geometry":{"type":"Polygon","coordinates":[[[)" + l + ",0],[" +
         r + ",0],[" + r + ",4],[" + l + ",4],[" + l + ",0]]]}}";
}

std::string door_text(const std::string& a, const std::string& b, double x) {
  const std::string at = std::to_string(x);
  return R"({"type":"Feature","properties":{"portal":true,"zones":[")" + a + R"(",")" + b +
         R"("]},"geometry":{"type":"LineString","coordinates":[[)" + at + ",1],[" + at + ",2]]}}";
}

std::string drawing_of(const std::vector<std::string>& features) {
  std::string text = R"({"type":"FeatureCollection","features":[)";
  for (std::size_t i = 0; i < features.size(); ++i) text += (i > 0 ? "," : "") + features[i];
  return text + "]}";
}

// Rooms a (x 0 to 4), b (4 to 8) and c (8 to 12) in a row, with a door between neighbours.
class RedrawnZones : public testing::Test {
 protected:
  RedrawnZones() {
    held_ = parse_zone_file(
                drawing_of({room_text("a", 0, 4), room_text("b", 4, 8), room_text("c", 8, 12),
                            door_text("a", "b", 4), door_text("b", "c", 8)}),
                kDefaultSnap_m)
                .plan;
  }

  std::string file(const std::vector<std::string>& features) {
    std::ofstream(disk_ / "new.geojson") << drawing_of(features);
    return (disk_ / "new.geojson").string();
  }

  template <typename Do>
  static std::string thrown_by(Do what) {
    try {
      what();
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  static std::vector<std::string> names(const ZonePlan& plan) {
    std::vector<std::string> out;
    for (const PlannedZone& zone : plan.zones) out.push_back(zone.name);
    return out;
  }
  static std::vector<std::string> portals(const ZonePlan& plan) {
    std::vector<std::string> out;
    for (const PlannedPortal& one : plan.portals) {
      out.push_back(plan.zones[one.zone_a].name + "-" + plan.zones[one.zone_b].name);
    }
    return out;
  }

  test_support::TemporaryFolder disk_;
  ZonePlan held_;
};

TEST_F(RedrawnZones, TakeTheNamedZoneWithItsPortalsAndLeaveTheRest) {
  // c grows to 14, its door moves; the file's d and its a are others' business.
  const Redrawn out =
      redraw(held_,
             file({room_text("a", 0, 3.5), room_text("c", 8, 14), room_text("d", 14, 18),
                   door_text("b", "c", 8), door_text("c", "d", 14)}),
             kDefaultSnap_m, {"c"});
  EXPECT_THAT(names(out.plan), ElementsAre("a", "b", "c"));
  EXPECT_THAT(out.fresh, ElementsAre("c"));
  EXPECT_THAT(out.not_taken, ElementsAre("d"));
  EXPECT_EQ(out.plan.zones[0].polygon.outer, held_.zones[0].polygon.outer);
  EXPECT_THAT(out.plan.zones[2].polygon.outer, testing::Contains(Point2{14, 4}));
  EXPECT_THAT(portals(out.plan), ElementsAre("a-b", "b-c"));
}

TEST_F(RedrawnZones, LoseThePortalsThatTheFileNoLongerDraws) {
  const Redrawn out =
      redraw(held_, file({room_text("c", 8, 12), room_text("a", 0, 4), door_text("a", "b", 4)}),
             kDefaultSnap_m, {"c"});
  EXPECT_THAT(portals(out.plan), ElementsAre("a-b"));
  ASSERT_EQ(out.warnings.size(), 1u);
  EXPECT_THAT(out.warnings[0], HasSubstr("zone 'c' is unreachable"));
}

TEST_F(RedrawnZones, AreRefusedWhenTheFileLacksOneOrOverlapsWhatStays) {
  EXPECT_THAT(
      thrown_by([&] { redraw(held_, file({room_text("a", 0, 4)}), kDefaultSnap_m, {"c"}); }),
      HasSubstr("draws no zone 'c', which --replace names"));
  // 7.5 to 8 is b's.
  EXPECT_THAT(
      thrown_by([&] { redraw(held_, file({room_text("c", 7.5, 12)}), kDefaultSnap_m, {"c"}); }),
      HasSubstr("overlap"));
}

TEST_F(RedrawnZones, TakeAllPartsOfOneThatWasSplit) {
  held_.zones[1].name = "b.1";
  held_.zones[2].name = "b.2";
  held_.zones[1].parent = held_.zones[2].parent = "b";
  const Redrawn out =
      redraw(held_, file({room_text("b", 4, 12), door_text("a", "b", 4)}), kDefaultSnap_m, {"b"});
  EXPECT_THAT(names(out.plan), ElementsAre("a", "b"));
  EXPECT_EQ(out.plan.zones[1].parent, "");
  EXPECT_THAT(portals(out.plan), ElementsAre("a-b"));
}

TEST_F(RedrawnZones, AddThoseThatTheMapLacks) {
  const Redrawn out = add_zones(
      held_, file({room_text("a", 0, 4), room_text("d", 12, 16), door_text("c", "d", 12)}),
      kDefaultSnap_m);
  EXPECT_THAT(names(out.plan), ElementsAre("a", "b", "c", "d"));
  EXPECT_THAT(out.fresh, ElementsAre("d"));
  EXPECT_THAT(portals(out.plan), ElementsAre("a-b", "b-c", "c-d"));
}

TEST_F(RedrawnZones, AddToTheMapOnlyWhereItsOwnZonesAreDrawnAlike) {
  EXPECT_THAT(thrown_by([&] { add_zones(held_, file({room_text("a", 0, 3.9)}), kDefaultSnap_m); }),
              HasSubstr("zone 'a' is drawn otherwise than in the map"));
  EXPECT_THAT(thrown_by([&] { add_zones(held_, file({room_text("d", 11, 16)}), kDefaultSnap_m); }),
              HasSubstr("overlap"));
  // The same ring from another vertex is drawn alike.
  const std::string turned =
      R"({"type":"Feature","properties":{"name":"a"},"geometry":{"type":"Polygon","coordinates":
          [[[4,4],[0,4],[0,0],[4,0],[4,4]]]}})";
  EXPECT_EQ(add_zones(held_, file({turned}), kDefaultSnap_m).fresh.size(), 0u);
}

TEST_F(RedrawnZones, LeadAPortalToThePartOfASplitZoneThatItTouches) {
  held_.zones[1].name = "b.1";
  held_.zones[2].name = "b.2";
  held_.zones[1].parent = held_.zones[2].parent = "b";
  const Redrawn out =
      add_zones(held_, file({room_text("d", 12, 16), door_text("b", "d", 12)}), kDefaultSnap_m);
  EXPECT_THAT(portals(out.plan), testing::Contains("b.2-d"));
}

}  // namespace
}  // namespace zonepack::packer
