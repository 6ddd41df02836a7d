// SPDX-License-Identifier: Apache-2.0
#include "platform/realtime.hpp"

#include <gtest/gtest.h>
#include <pthread.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <string>

#include "platform/clock.hpp"

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
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "the thread sanitizer keeps most of a stack for itself";
#endif
  auto thread = Thread::start({.name = "zp-test"}, false, [&] {
    const ThreadUsage before = thread_usage();
    volatile char used[160 * 1024];
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

}  // namespace
}  // namespace zonepack
