// SPDX-License-Identifier: Apache-2.0
#include "platform/base/last_act.hpp"

#include <gtest/gtest.h>

#include <cstdio>

#include "platform/base/require.hpp"

namespace zonepack {
namespace {

void say_it() noexcept { std::fputs("outputs are safe\n", stderr); }
void fail_again() noexcept {
  std::fputs("once\n", stderr);
  ZP_REQUIRE(1 > 2);
}

TEST(LastAct, IsDoneOnceBeforeAFailedConditionStopsTheProcess) {
  EXPECT_DEATH(
      {
        set_last_act(say_it);
        ZP_REQUIRE(1 > 2);
      },
      "1 > 2 does not hold.*\n.*outputs are safe");
  EXPECT_DEATH(
      {
        set_last_act(fail_again);
        ZP_REQUIRE(2 > 3);
      },
      "2 > 3 .*\nonce\n.*1 > 2 ");
}

}  // namespace
}  // namespace zonepack
