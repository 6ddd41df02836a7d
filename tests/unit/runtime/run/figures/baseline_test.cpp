// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/figures/baseline.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace zonepack {
namespace {

class BaselineTest : public testing::Test {
 protected:
  std::string problem_of(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    return problem_reading(path_);
  }

  std::string problem_reading(const std::string& path) {
    auto rows = read_baseline(path);
    if (!rows) return rows.error().message;
    rows_ = std::move(*rows);
    return "";
  }

  test_support::TemporaryFolder folder_;
  std::string path_ = (folder_ / "baseline.csv").string();
  std::vector<BaselineRow> rows_;
};

TEST_F(BaselineTest, ReadsTheColumnsByName) {
  EXPECT_EQ(problem_of("# init_ms=5\n"
                       "wm,other,t,cum_retrieved,cum_removed\r\n"
                       "184,x,1000.5,0,2\r\n"
                       "183,y,1001,1,5\r\n"),
            "");
  ASSERT_EQ(rows_.size(), 2u);
  EXPECT_DOUBLE_EQ(rows_[0].t_s, 0);
  EXPECT_DOUBLE_EQ(rows_[0].in_memory, 184);
  EXPECT_DOUBLE_EQ(rows_[0].unloaded, 1);  // 2 removed, one of them the query image
  EXPECT_DOUBLE_EQ(rows_[1].t_s, 0.5);
  EXPECT_DOUBLE_EQ(rows_[1].loaded, 1);
  EXPECT_DOUBLE_EQ(rows_[1].unloaded, 3);  // 5 removed, two of them query images
}

TEST_F(BaselineTest, ReadsRtabmapOnScenario1) {
  const std::string path = std::string(ZONEPACK_TEST_DATA) +
                           "/rtabmap_baseline/small_scenario1_loop_thr100_ret10_inittrue.csv";
  EXPECT_EQ(problem_reading(path), "");
  ASSERT_EQ(rows_.size(), 221u);
  EXPECT_DOUBLE_EQ(rows_.back().loaded, 981);
  EXPECT_DOUBLE_EQ(rows_.back().unloaded, 1071);  // 1292 removed - 221 images
  EXPECT_DOUBLE_EQ(rows_.back().t_s, 110);
}

TEST_F(BaselineTest, NamesFileLineAndWhatWasExpected) {
  const std::string head = "t,wm,cum_removed,cum_retrieved\n";
  EXPECT_EQ(problem_of("t,wm,cum_removed\n"),
            path_ +
                ":1: no column 'cum_retrieved'; expected the columns t, wm, cum_removed, "
                "cum_retrieved");
  EXPECT_EQ(problem_of(head + "1,2,3\n"), path_ + ":2: 3 cells where the column names have 4");
  EXPECT_EQ(problem_of(head + "1,2,3,4\n1,2,three,4\n"),
            path_ + ":3: column cum_removed: 'three' is not a number");
  EXPECT_EQ(problem_of(head + "1,nan,3,4\n"), path_ + ":2: column wm: 'nan' is not a number");
  EXPECT_EQ(problem_of(head + "2,2,3,4\n1,2,3,4\n"), path_ + ":3: time goes back");
}

TEST_F(BaselineTest, RefusesAFileWithoutRows) {
  EXPECT_NE(problem_of("").find("no rows"), std::string::npos);
  EXPECT_NE(problem_of("t,wm,cum_removed,cum_retrieved\n").find("no rows"), std::string::npos);
}

TEST_F(BaselineTest, NamesAFileThatIsMissing) {
  const std::string missing = path_ + ".missing";
  EXPECT_EQ(problem_reading(missing),
            missing + ": cannot read the baseline: No such file or directory");
}

}  // namespace
}  // namespace zonepack
