// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/explain/query_reason.hpp"

#include <gtest/gtest.h>

#include "runtime/localize/explain/query_command.hpp"

namespace zonepack::localize {
namespace {

TEST(ReasonText, NamesTheFiguresThatDecided) {
  QueryResult result;
  result.reason = Reason::kFewMatches;
  result.matches = 12;
  result.nearest = 412;
  result.nearest_m = 0.8;
  result.nearest_turn_rad = 1.6406;  // 94 degrees
  QueryAsked asked;
  asked.needed = 15;
  asked.with_prior = true;
  asked.nearest_zone = "L1";
  EXPECT_EQ(
      query_reason(result, asked),
      "12 of 15 matches needed; the nearest signature (412 in L1, 0.8 m away) looks 94 degrees "
      "to the side");
}

TEST(ReasonText, SaysHowMuchEvidenceIsMissing) {
  QueryResult result;
  result.reason = Reason::kChance;
  result.distinct = 18;
  result.visible = 120;
  result.evidence = 1.25;
  EXPECT_EQ(query_reason(result, {}),
            "18 matches agree, but no more and no more alike than chance gives where 120 features "
            "have a point of the map nearby (evidence 1.2 of 4.0 needed)");
  result.looked_at = 60;
  result.recognised = 2;
  EXPECT_EQ(query_reason(result, {}),
            "18 matches agree, but no more and no more alike than chance gives where 120 features "
            "have a point of the map nearby (evidence 1.2 of 4.0 needed; of 60 places more where "
            "the map has a point, 2 look like it)");
}

TEST(ReasonText, SaysSomethingForEveryReason) {
  for (std::size_t i = 0; i < kReasons; ++i) {
    QueryResult result;
    result.reason = static_cast<Reason>(i);
    EXPECT_FALSE(query_reason(result, {}).empty()) << i;
    EXPECT_STRNE(to_string(result.reason), "?") << i;
  }
}

}  // namespace
}  // namespace zonepack::localize
