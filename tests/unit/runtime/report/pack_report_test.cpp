// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/pack_report.hpp"

#include <gtest/gtest.h>

#include "tests/support/xml_check.hpp"

namespace zonepack::report {
namespace {

PackReport two_zones() {
  PackReport map;
  map.map = "build/demo/map";
  map.version = "c0ffee";
  map.payload = "features, scan";
  map.zones = {{"H1",
                "corridor",
                "west <corridor>",
                "",
                {{{0, 0}, {8, 0}, {8, 2}, {0, 2}}, {}},
                16,
                4800,
                1048576,
                700000,
                {{1, 1}, {7, 1}}},
               {"L1",
                "lobby",
                "",
                "",
                {{{0, 2}, {8, 2}, {8, 9}, {0, 9}}, {}},
                31,
                9300,
                2097152,
                1400000,
                {{4, 4}}}};
  map.portals = {{{2, 2}, {4, 2}}};
  map.table_bytes = 102400;
  map.smallest_budget_bytes = 3248128;  // 1048576 + 2097152 + 102400
  map.smallest_budget_pair = "H1 with L1";
  return map;
}

TEST(PackReport, StatesTheSmallestBudgetAndItsPair) {
  const Report page = make_pack_report(two_zones());
  EXPECT_EQ(page.facts[0].value, "3.1 MiB");
  EXPECT_EQ(page.facts[0].note,
            "3\xE2\x80\x89"
            "248\xE2\x80\x89"
            "128 bytes");
  EXPECT_EQ(page.facts[1].value, "H1 with L1");
}

TEST(PackReport, ColoursZonesByWhatTheyCharge) {
  const std::string html = to_html(make_pack_report(two_zones()));
  EXPECT_EQ(XmlCheck::problem_in(html), "");
  // L1 charges most, H1 half of it. Halos of labels repeat the fill.
  EXPECT_EQ(count_of(html, "Z\" fill=\"" + to_hex(ramp_color(1)) + "\""), 2u);  // wide and narrow
  EXPECT_EQ(count_of(html, "Z\" fill=\"" + to_hex(ramp_color(0.5)) + "\""), 2u);
  EXPECT_EQ(count_of(html, "<circle"), 8u);  // twice: three signatures and the legend's dot
}

TEST(PackReport, ListsEveryZone) {
  const Report page = make_pack_report(two_zones());
  ASSERT_EQ(page.tables.size(), 1u);
  ASSERT_EQ(page.tables[0].rows.size(), 2u);
  const auto& h1 = page.tables[0].rows[0];
  EXPECT_EQ(h1[0], "H1");
  EXPECT_EQ(h1[3], "16.0");  // 8 m x 2 m
  EXPECT_EQ(h1[4], "16");
  EXPECT_EQ(h1.back(), "64 KiB");  // 1 MiB / 16
  EXPECT_EQ(h1.size(), page.tables[0].columns.size());
}

TEST(PackReport, DrawsOneZoneNoSignaturesAndNothing) {
  PackReport map = two_zones();
  map.zones.resize(1);
  map.zones[0].signatures = 0;
  map.zones[0].charged_bytes = 0;
  map.zones[0].signature_positions.clear();
  EXPECT_EQ(XmlCheck::problem_in(to_html(make_pack_report(map))), "");
  EXPECT_EQ(make_pack_report(map).tables[0].rows[0].back(), "");
  EXPECT_EQ(XmlCheck::problem_in(to_sheet(make_pack_report(PackReport{})).file_text()), "");
}

TEST(PackReport, TheSameMapGivesTheSameBytes) {
  EXPECT_EQ(to_html(make_pack_report(two_zones())), to_html(make_pack_report(two_zones())));
}

}  // namespace
}  // namespace zonepack::report
