// SPDX-License-Identifier: Apache-2.0
#include "platform/process/realtime.hpp"

#include <gtest/gtest.h>
#include <pthread.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "platform/memory/foreign_heap.hpp"
#include "platform/process/clock.hpp"

namespace zonepack {
namespace {

TEST(Thread, RunsItsBodyUnderItsNameAndIsJoined) {
  std::string name;
  {
    auto thread = Thread::start({.name = "zp-test"}, false, [&] {
      std::array<char, 16> text{};
      pthread_getname_np(pthread_self(), text.data(), text.size());
      name = text.data();
    });
    ASSERT_TRUE(thread.ok());
    EXPECT_FALSE(thread->is_realtime());
  }
  EXPECT_EQ(name, "zp-test");
}

TEST(Thread, SaysWhyItCannotRunAsAskedAndLeavesNoThread) {
  bool ran = false;
  const auto thread = Thread::start({.name = "zp-test", .cpu = 1023}, false, [&] { ran = true; });
  ASSERT_FALSE(thread.ok());
  EXPECT_EQ(thread.error(), (Error{ErrorCode::kIo, EINVAL}));
  EXPECT_FALSE(ran);
}

TEST(Thread, UsesItsStackWithoutAFault) {
  std::uint64_t faults = 1;
#ifdef ZONEPACK_FOREIGN_STACK
  GTEST_SKIP() << "the thread sanitizer keeps most of a stack for itself";
#endif
  auto thread = Thread::start({.name = "zp-test"}, false, [&] {
    const ThreadUsage before = thread_usage();
    volatile char used[96 * 1024];
    for (std::size_t at = 0; at < sizeof used; at += 4096) used[at] = 1;
    faults = thread_usage().minor_faults - before.minor_faults;
  });
  ASSERT_TRUE(thread.ok());
  thread->join();
  EXPECT_EQ(faults, 0u);
}

TEST(Clock, SleepsUntilATimeAndNotIfItHasPassed) {
  const std::int64_t before = monotonic_ns();
  sleep_until_ns(before - 1'000'000'000'000);
  sleep_until_ns(before + 2'000'000);
  EXPECT_GE(monotonic_ns(), before + 2'000'000);
}

TEST(ProcessPeak, IsAtLeastWhatTheProcessTouched) { EXPECT_GT(process_peak_bytes(), 1'000'000u); }

// Of a line "KEY:  123 kB" of /proc/self/status, in bytes.
std::uint64_t status_bytes(const std::string& key) {
  std::ifstream file("/proc/self/status");
  for (std::string word; file >> word;) {
    std::uint64_t kib = 0;
    if (word == key && file >> kib) return kib * 1024;
  }
  return 0;
}

// Locked bytes of the code of a library that is mapped here (smaps).
std::uint64_t locked_code_of(const std::string& library) {
  std::ifstream file("/proc/self/smaps");
  bool wanted = false;
  std::uint64_t kib = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.find(" r-xp ") != std::string::npos) {
      wanted = line.find(library) != std::string::npos;
    } else if (line.find(" r--p ") != std::string::npos ||
               line.find(" rw-p ") != std::string::npos) {
      wanted = false;
    } else if (wanted && line.starts_with("Locked:")) {
      kib += std::stoull(line.substr(7));
    }
  }
  return kib * 1024;
}

TEST(LockMemory, TakesWhatAControlThreadTouchesAndNotTheCodeOfOtherLibraries) {
#ifdef ZONEPACK_FOREIGN_HEAP
  GTEST_SKIP() << "the sanitizers leave mlock() out";
#endif
  const std::vector<char> written(8 << 20);
  if (!lock_memory_now()) GTEST_SKIP() << "no privilege to lock memory";
  EXPECT_GE(status_bytes("VmLck:"), written.size());
  EXPECT_GT(locked_code_of("/libc.so.6"), 0u);
  EXPECT_GT(locked_code_of("/test_platform"), 0u);
  EXPECT_EQ(locked_code_of("/libstdc++.so.6"), 0u);
  unlock_memory();
  EXPECT_EQ(status_bytes("VmLck:"), 0u);
}

// In a process of its own, whose heap nothing else has divided: 32 MiB are taken and freed, which
// one heap keeps, and given back.
TEST(OneHeapDeathTest, KeepsWhatIsFreedUntilItIsGivenBack) {
#ifdef ZONEPACK_FOREIGN_HEAP
  GTEST_SKIP() << "the sanitizers have a heap of their own";
#endif
  constexpr std::size_t kBlock = 64 * 1024, kBlocks = 512;
  const auto rss = [] { return status_bytes("VmRSS:"); };
  EXPECT_EXIT(
      {
        use_one_heap(1 << 20);
        const std::uint64_t before = rss();
        std::vector<void*> blocks;
        for (std::size_t i = 0; i < kBlocks; ++i) {
          blocks.push_back(std::memset(std::malloc(kBlock), 1, kBlock));
        }
        for (void* const block : blocks) std::free(block);
        const std::uint64_t freed = rss();
        give_back_heap();
        const std::uint64_t after = rss();
        // 32 MiB more, the first of which was present already; and as much less, but for 256 KiB.
        // The kernel counts to within 1 MiB.
        constexpr std::uint64_t kAlmostAll = kBlock * kBlocks - (2 << 20);
        const bool kept = freed >= before + kAlmostAll;
        const bool given = after + kAlmostAll <= freed;
        std::exit(kept && given ? 0 : 1);
      },
      testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace zonepack
