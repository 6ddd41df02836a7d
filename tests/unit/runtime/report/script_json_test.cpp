// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/script_json.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "runtime/report/chart.hpp"

namespace zonepack::report {
namespace {

TEST(ScriptJson, NothingInATextEndsTheScript) {
  EXPECT_EQ(script_string("</script>"), "\"\\u003c/script\\u003e\"");
  EXPECT_EQ(script_string("a \"b\" & \\ \n"), "\"a \\\"b\\\" \\u0026 \\\\ \\u000a\"");
}

TEST(ScriptJson, BytesThatAreNoTextAreReplaced) {
  EXPECT_EQ(script_string("\xC3\xBC\xFF"), "\"\xC3\xBC\xEF\xBF\xBD\"");
}

TEST(ScriptJson, NumbersAreDifferencesInWholeUnits) {
  // 1.2345 m is 1235 mm (1234.5 rounds away from zero), then -1000 and, past the gap, +1765.
  const std::vector<double> values = {1.2345, 0.2345, std::numeric_limits<double>::quiet_NaN(), 2};
  EXPECT_EQ(script_differences(values, 1000), "[1235,-1000,null,1765]");
  EXPECT_EQ(script_differences({}, 1), "[]");
  EXPECT_EQ(script_numbers(std::vector<std::int64_t>{3, -1}), "[3,-1]");
}

TEST(ScriptJson, AChartIsItsSeriesWithoutRepetition) {
  Chart chart;
  chart.series = {{.name = "loaded", .samples = {{0, 0}, {0.5, 31}, {1, 31}, {2, 47}}}};
  EXPECT_EQ(chart_json(chart),
            "{\"kind\":\"chart\",\"bytes\":false,\"unit\":\"\",\"series\":[{\"name\":\"loaded\","
            "\"color\":\"#0b5fa5\",\"steps\":true,\"per\":1,\"t\":[0,500,1500],\"v\":[0,31,16]}]}");
}

}  // namespace
}  // namespace zonepack::report
