// SPDX-License-Identifier: Apache-2.0
// Drawings that no person makes end within seconds, in a message that names the limit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <numbers>
#include <string>

#include "packer/zones/geojson.hpp"
#include "packer/zones/zone_checks.hpp"
#include "packer/zones/zone_file.hpp"

namespace zonepack::packer {
namespace {

using ::testing::HasSubstr;

class HostileDrawing : public ::testing::Test {
 protected:
  void add_zone(const std::string& name, const Ring& ring) {
    std::string list;
    for (const Point2 p : ring) {
      list += "[" + std::to_string(p.x_m) + "," + std::to_string(p.y_m) + "],";
    }
    list += "[" + std::to_string(ring[0].x_m) + "," + std::to_string(ring[0].y_m) + "]";
    features_ +=
        (features_.empty() ? "" : ",\n") +
        (R"({"type":"Feature","properties":{"name":")" + name +
         R"(","zone_type":"room"},"geometry":{"type":"Polygon","coordinates":[[)" + list + "]]}}");
  }

  Findings check() {
    const std::clock_t start = std::clock();  // of the processor: the machine may be busy
    const ZoneFile file =
        parse_zone_file(R"({"type":"FeatureCollection","features":[)" + features_ + "]}");
    took_ =
        std::chrono::duration<double>(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    return file.findings;
  }

  std::string features_;
  std::chrono::duration<double> took_{};
};

// A bar of height 1 below `teeth` teeth of length 1000, or the same on its side.
Ring comb(int teeth, bool sideways) {
  Ring ring{{0, 0}, {2.0 * teeth, 0}};
  for (int i = teeth; i-- > 0;) {
    const double x = 2 * i + 0.3;
    for (const Point2 p : {Point2{x + 1, 1}, Point2{x + 1, 1000}, Point2{x, 1000}, Point2{x, 1}}) {
      ring.push_back(p);
    }
  }
  if (sideways) {
    for (Point2& p : ring) p = {p.y_m, p.x_m};
  }
  return ring;
}

Ring circle(int vertices, double x, double y, double radius) {
  Ring ring;
  for (int i = 0; i < vertices; ++i) {
    const double angle = 2 * std::numbers::pi * i / vertices;
    ring.push_back({x + radius * std::cos(angle), y + radius * std::sin(angle)});
  }
  return ring;
}

// A thousand teeth of each cross 500 of the other: half a million squares.
TEST_F(HostileDrawing, OfCombsThatCrossEverywhereIsRefusedByALimit) {
  add_zone("A", comb(1000, false));
  add_zone("B", comb(1000, true));
  const Findings findings = check();
  ASSERT_EQ(findings.faults.size(), 1u);
  EXPECT_THAT(findings.faults[0].message,
              HasSubstr("zones 'A' and 'B' cross in too many places to measure"));
  EXPECT_LT(took_, std::chrono::seconds(60));  // the limit holds it to some seconds
}

TEST_F(HostileDrawing, OfSmallCombsIsStillMeasured) {
  add_zone("A", comb(50, false));
  add_zone("B", comb(50, true));
  const Findings findings = check();
  ASSERT_EQ(findings.faults.size(), 1u);
  EXPECT_THAT(findings.faults[0].message, HasSubstr("zones 'A' and 'B' overlap by "));
}

TEST_F(HostileDrawing, OfTwentyCirclesWithAllTheirVerticesIsMeasuredInSeconds) {
  for (int i = 0; i < 20; ++i) {
    add_zone("C" + std::to_string(i), circle(4096, i * 0.3, i * 0.2, 10));
  }
  const Findings findings = check();
  EXPECT_EQ(findings.faults.size(), 20u * 19u / 2u);  // each overlaps each
  EXPECT_LT(took_, std::chrono::seconds(60));
}

TEST_F(HostileDrawing, OfADoubleKeyAMillionTimesStopsAtTheFirstTenThousand) {
  std::string object = R"({"type":"Feature")";
  for (int i = 0; i < 1'000'000; ++i) object += R"(,"a":1)";
  features_ = object + "}";
  const Findings findings = check();
  EXPECT_EQ(findings.faults.size(), 10'000u);  // 9,999 keys again, and the limit
  EXPECT_EQ(findings.faults.left_out(), findings.faults.size() - FindingList::kMost);
  EXPECT_LT(took_, std::chrono::seconds(10));
}

TEST_F(HostileDrawing, OfManyKeysIsRefusedByName) {
  std::string object = R"({"type":"Feature")";
  for (int i = 0; i < 20'000; ++i) object += ",\"k" + std::to_string(i) + "\":1";
  features_ = object + "}";
  EXPECT_THAT(check().faults[0].message, HasSubstr("holds an object of more than 10000 keys"));
}

TEST_F(HostileDrawing, OfTooManyValuesIsRefusedByName) {
  features_ = "[0";
  for (std::size_t i = 0; i < kMaxJsonValues; ++i) features_ += ",0";
  features_ += "]";
  EXPECT_THAT(check().faults[0].message, HasSubstr("holds more than 4000000 values"));
}

TEST(Findings, AreCountedWhenTheyAreTooManyToKeep) {
  Findings findings;
  for (int i = 0; i < 1500; ++i) findings.faults.push_back({std::nullopt, 0, "", "wrong"});
  EXPECT_EQ(findings.faults.size(), 1500u);
  EXPECT_THAT(describe_faults(findings, "a.geojson"), HasSubstr("1500 faults in the zone file"));
  EXPECT_THAT(describe_faults(findings, "a.geojson"), ::testing::EndsWith("and 500 more"));
}

}  // namespace
}  // namespace zonepack::packer
