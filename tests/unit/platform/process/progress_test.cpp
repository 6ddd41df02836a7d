// SPDX-License-Identifier: Apache-2.0
#include "platform/process/progress.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <sstream>
#include <thread>

namespace zonepack {
namespace {

TEST(Progress, IsOneLineAStageWhereNobodyWatches) {
  std::ostringstream out;
  Progress progress(out, false);
  progress.start("reading", 3, "drives");
  progress.advance(3);
  EXPECT_EQ(out.str(), "");
  progress.finish("3 drives");
  EXPECT_EQ(out.str(), "reading: 3 drives in 0.0 s\n");
}

TEST(Progress, DrawsCountRateAndTimeLeftOnATerminal) {
  std::ostringstream out;
  Progress progress(out, true);
  progress.start("evaluating", 4, "runs");
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  progress.advance();
  // One of four after at least half a second: a quarter of the bar, at most 2 a second.
  const std::string drawn = out.str();
  EXPECT_NE(drawn.find("evaluating [######..................] 1/4 runs, "), std::string::npos)
      << drawn;
  EXPECT_NE(drawn.find("/s, "), std::string::npos) << drawn;
  EXPECT_NE(drawn.find(" s left"), std::string::npos) << drawn;
  EXPECT_EQ(drawn.find(" 0/s"), std::string::npos) << drawn;  // a slow rate has a decimal
}

}  // namespace
}  // namespace zonepack
