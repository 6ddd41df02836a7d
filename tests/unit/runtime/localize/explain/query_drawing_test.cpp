// SPDX-License-Identifier: Apache-2.0
// What is drawn is looked for in the SVG: green is a match that agrees, red one that does not.
#include "runtime/localize/explain/query_drawing.hpp"

#include <gmock/gmock.h>

#include <string_view>

#include "runtime/localize/solve/sighting.hpp"
#include "tests/support/small_map.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/xml_check.hpp"

namespace zonepack::localize {
namespace {

using testing::HasSubstr;
using testing::Not;

std::size_t count_of(const std::string& text, std::string_view what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + 1)) ++count;
  return count;
}

DrawnMatch match_of(SignatureId signature, bool inlier) {
  DrawnMatch match;
  match.x_px = inlier ? 64 : 320;
  match.y_px = inlier ? 48 : 240;
  match.map_x_px = inlier ? 128 : 640;
  match.map_y_px = inlier ? 96 : 480;
  match.p_map = {2, 3, 1};
  match.signature = signature;
  match.inlier = inlier;
  return match;
}

// Drawn 900 px wide, the image of 640 is 1.40625 times as large: 64, 48 is at 90, 67.5; where the
// pose puts the point, 128, 96, is at 180, 135.
TEST(DrawnMatches, StandWhereTheImageHasThemUnderTheirPoint) {
  const GreyImage image{640, 480, 0, std::vector<std::uint8_t>(640 * 480, 90)};
  QueryResult result;
  result.drawn = {match_of(1, true), match_of(1, false)};
  const report::Svg svg = draw_matches(image, result);
  EXPECT_EQ(svg.width(), 900);
  EXPECT_EQ(svg.height(), 675);
  const std::string text = svg.file_text();
  EXPECT_EQ(XmlCheck::problem_in(text), "");
  EXPECT_THAT(text, HasSubstr("image/png"));
  EXPECT_THAT(text, HasSubstr("cx=\"90\" cy=\"67.5\""));
  EXPECT_THAT(text, HasSubstr("cx=\"180\" cy=\"135\""));  // the point of the one that agrees
  EXPECT_THAT(text, HasSubstr("cx=\"450\" cy=\"337.5\""));
  EXPECT_THAT(text, Not(HasSubstr("cx=\"900\"")));  // none of the other
  EXPECT_EQ(count_of(text, "a match that the pose explains"), 1u);
  EXPECT_EQ(count_of(text, "a match that disagrees"), 1u);
  EXPECT_LT(text.find("a match that disagrees"), text.find("a match that the pose explains"));
}

class DrawnPlace : public testing::Test {
 protected:
  DrawnPlace() {
    test_support::SmallMap map;  // rooms a and b, 4 m wide and side by side
    for (const auto& [name, bytes] : map.folder.files) {
      test_support::write_bytes(folder / name, bytes);
    }
    catalog = *Catalog::open(folder.path().string(), kDefaultPayload);
    for (const SignatureId id : {1, 2}) {
      MapFeatures& one = features.emplace_back();
      one.id = id;
      one.T_map_base = lift({id == 1 ? 2.0 : 6.0, 2, 0}, 0);
    }
    result.pose = {2.1, 2, 0};
    result.drawn = {match_of(1, true), match_of(2, false)};
  }
  std::string drawn(const std::optional<Pose2>& guess) const {
    const std::string text = draw_place(catalog, features, result, guess).file_text();
    EXPECT_EQ(XmlCheck::problem_in(text), "");
    return text;
  }

  static constexpr const char *kGreen = "#119933", *kRed = "#cc3311", *kBlue = "#3366cc";
  test_support::TemporaryFolder folder;
  Catalog catalog;
  std::vector<MapFeatures> features;
  QueryResult result;
};

TEST_F(DrawnPlace, ShowsTheWholeMapWhereNothingIsKnown) {
  const std::string text = drawn({});
  EXPECT_THAT(text, HasSubstr(">a</text>"));
  EXPECT_THAT(text, HasSubstr(">b</text>"));
  EXPECT_THAT(text, Not(HasSubstr(kBlue)));
  // Signature 1 and its direction are green, no robot.
  EXPECT_EQ(count_of(text, "signature 1"), 2u);
  EXPECT_EQ(count_of(text, kGreen), 2u);
}

TEST_F(DrawnPlace, ShowsTheRobotInGreenWhenItsPoseIsBelieved) {
  result.found = result.accepted = true;
  const std::string text = drawn({});
  EXPECT_EQ(count_of(text, kGreen), 2u + 2u);  // signature 1; the arrow's ground and border
  EXPECT_THAT(text, Not(HasSubstr(kRed)));
}

TEST_F(DrawnPlace, ShowsTheRobotInRedWhenItsPoseIsRefused) {
  result.found = true;
  const std::string text = drawn({});
  EXPECT_EQ(count_of(text, kGreen), 2u);
  EXPECT_EQ(count_of(text, kRed), 2u);
}

TEST_F(DrawnPlace, OutlinesWhereTheRobotWasSaidToBe) {
  const std::string text = drawn(Pose2{3, 2, 0});
  EXPECT_EQ(count_of(text, kBlue), 1u);  // a border alone
}

}  // namespace
}  // namespace zonepack::localize
