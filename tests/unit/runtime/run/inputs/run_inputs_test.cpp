// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/inputs/run_inputs.hpp"

#include <gtest/gtest.h>
#include <sys/sysinfo.h>

#include "platform/devices/board.hpp"

namespace zonepack {
namespace {

TEST(DefaultBudgetLimit, IsAQuarterOfTheMemoryThereIs) {
  const ByteCount limit = default_budget_limit();
  EXPECT_EQ(limit, machine_memory_bytes() / 4);
  EXPECT_EQ(default_budget_limit(), limit) << "it stays what it was at first";
  // Never more than a quarter of what is built in, by another call of the kernel; a container's own
  // limit may be less.
  struct sysinfo machine {};
  ASSERT_EQ(sysinfo(&machine), 0);
  EXPECT_GT(limit, 0U);
  EXPECT_LE(limit, ByteCount{machine.totalram} * machine.mem_unit / 4);
}

}  // namespace
}  // namespace zonepack
