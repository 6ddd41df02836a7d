// SPDX-License-Identifier: Apache-2.0
#include "platform/devices/board.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "tests/support/temporary_folder.hpp"

namespace zonepack {
namespace {

class Board : public testing::Test {
 protected:
  void put(const std::string& path, const std::string& text) {
    const std::filesystem::path file = root + path;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text << '\n';
  }

  BoardFact fact(const std::string& name, const BoardNeeds& needs = {80, 3, 1'000'000}) {
    for (const BoardFact& found : inspect_board(needs, root)) {
      if (found.name == name) return found;
    }
    ADD_FAILURE() << name;
    return {};
  }

  test_support::TemporaryFolder folder;
  std::string root = folder.path();
};

TEST_F(Board, FindsAnIdleStateThatWakesUpTooLateAndSaysHowToEndIt) {
  put("/sys/devices/system/cpu/cpu0/cpuidle/state0/latency", "0");
  put("/sys/devices/system/cpu/cpu0/cpuidle/state2/latency", "350");
  put("/sys/devices/system/cpu/cpu0/cpuidle/state2/disable", "0");
  EXPECT_FALSE(fact("idle states").good);
  EXPECT_EQ(fact("idle states").found, "state2 wakes up in 350 us");
  EXPECT_NE(fact("idle states").mend.find("cpuidle/state2/disable"), std::string::npos);
  put("/sys/devices/system/cpu/cpu0/cpuidle/state2/disable", "1");
  EXPECT_TRUE(fact("idle states").good);
}

TEST_F(Board, FindsAGovernorThatSavesPower) {
  put("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance");
  EXPECT_TRUE(fact("frequency governor").good);
  put("/sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "schedutil");
  EXPECT_FALSE(fact("frequency governor").good);
  EXPECT_EQ(fact("frequency governor").found, "schedutil");
}

TEST_F(Board, LooksForTheControlThreadsProcessorAmongTheIsolatedOnes) {
  for (const char* list : {"3", "1-3", "0,2-4"}) {
    put("/sys/devices/system/cpu/isolated", list);
    EXPECT_TRUE(fact("isolated processors").good) << list;
  }
  for (const char* list : {"", "2", "0-2,4"}) {
    put("/sys/devices/system/cpu/isolated", list);
    EXPECT_FALSE(fact("isolated processors").good) << list;
  }
  EXPECT_FALSE(fact("isolated processors", {80, std::nullopt, 0}).good);
}

TEST_F(Board, CountsInterruptsThatMayRunOnTheControlThreadsProcessor) {
  put("/proc/irq/7/smp_affinity_list", "0-3");
  put("/proc/irq/8/smp_affinity_list", "0");
  EXPECT_EQ(fact("interrupts").found, "1 may run on processor 3");
  EXPECT_FALSE(fact("interrupts").good);
}

TEST_F(Board, ReadsWhatTheKernelLetsBeSet) {
  put("/proc/sys/kernel/sched_rt_runtime_us", "950000");
  EXPECT_FALSE(fact("real-time throttling").good);
  put("/proc/sys/kernel/sched_rt_runtime_us", "-1");
  EXPECT_TRUE(fact("real-time throttling").good);
  put("/proc/sys/vm/compact_unevictable_allowed", "1");
  EXPECT_EQ(fact("compaction of locked pages").mend, "sysctl -w vm.compact_unevictable_allowed=0");
  put("/sys/kernel/realtime", "1");
  EXPECT_TRUE(fact("PREEMPT_RT").good);
  put("/sys/fs/cgroup/memory.max", "999999");
  EXPECT_FALSE(fact("memory limit of the cgroup").good);
}

TEST_F(Board, FindsNothingWrongWithWhatIsUnknown) {
  for (const char* name : {"frequency governor", "idle states", "real-time throttling",
                           "compaction of locked pages", "memory limit of the cgroup"}) {
    EXPECT_TRUE(fact(name).good) << name;
  }
}

class MachineMemory : public testing::Test {
 protected:
  void write(const std::string& path, const std::string& text) {
    const std::filesystem::path file = root_.path() / path;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }
  ByteCount bytes() const { return machine_memory_bytes(root_.path().string()); }
  test_support::TemporaryFolder root_;
};

TEST_F(MachineMemory, IsWhatTheKernelHasUnlessTheContainerHasLess) {
  write("proc/meminfo", "MemFree:  1 kB\nMemTotal:        2000 kB\nSwapTotal: 9 kB\n");
  EXPECT_EQ(bytes(), 2'048'000u);  // 2000 * 1024
  write("sys/fs/cgroup/memory.max", "max\n");
  EXPECT_EQ(bytes(), 2'048'000u);
  write("sys/fs/cgroup/memory.max", "1000000\n");
  EXPECT_EQ(bytes(), 1'000'000u);
  write("sys/fs/cgroup/memory.max", "3000000\n");
  EXPECT_EQ(bytes(), 2'048'000u);
}

TEST_F(MachineMemory, IsWithoutLimitWhereNothingIsKnown) {
  EXPECT_EQ(bytes(), std::numeric_limits<ByteCount>::max());
  write("proc/meminfo", "MemTotal: many kB\n");
  EXPECT_EQ(bytes(), std::numeric_limits<ByteCount>::max());
}

}  // namespace
}  // namespace zonepack
