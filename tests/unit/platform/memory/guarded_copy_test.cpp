// SPDX-License-Identifier: Apache-2.0
#include "platform/memory/guarded_copy.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>

#include <array>
#include <thread>
#include <vector>

#include "tests/support/numbered_file.hpp"

namespace zonepack {
namespace {

using test_support::are_numbers;
using test_support::NumberedFile;

constexpr std::size_t kFileBytes = 64 * 1024;

class Mapping {
 public:
  explicit Mapping(const NumberedFile& file)
      : at_(::mmap(nullptr, kFileBytes, PROT_READ, MAP_SHARED, file.fd(), 0)) {}
  ~Mapping() { ::munmap(at_, kFileBytes); }
  const std::byte* bytes() const { return static_cast<const std::byte*>(at_); }

 private:
  void* at_;
};

TEST(GuardedCopy, CopiesWhatIsThere) {
  const NumberedFile file(kFileBytes);
  const Mapping mapping(file);
  std::vector<std::byte> out(1000);
  EXPECT_TRUE(guarded_copy(out.data(), mapping.bytes() + 5000, out.size()));
  EXPECT_TRUE(are_numbers(out, 5000));
  EXPECT_TRUE(guarded_copy(out.data(), mapping.bytes(), 0));
}

TEST(GuardedCopy, SaysNoAgainAndAgainWhereTheFileWasCutShort) {
  NumberedFile file(kFileBytes);
  const Mapping mapping(file);
  file.cut_to(5000);  // ends in the second page
  std::vector<std::byte> out(kFileBytes);
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(guarded_copy(out.data(), mapping.bytes(), kFileBytes));
    EXPECT_FALSE(guarded_copy(out.data(), mapping.bytes() + kFileBytes - 1, 1));
    EXPECT_TRUE(guarded_copy(out.data(), mapping.bytes(), 5000));
  }
  EXPECT_TRUE(are_numbers(std::span(out).first(5000), 0));
}

TEST(GuardedCopy, ServesThreadsAtTheSameTime) {
  std::array<int, 4> right{};
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < right.size(); ++i) {
      threads.emplace_back([&right, i] {
        NumberedFile file(kFileBytes);
        const Mapping mapping(file);
        if (i % 2 == 1) file.cut_to(0);
        std::vector<std::byte> out(kFileBytes);
        for (int round = 0; round < 200; ++round) {
          right[i] += guarded_copy(out.data(), mapping.bytes(), kFileBytes) == (i % 2 == 0) ? 1 : 0;
        }
      });
    }
  }
  EXPECT_EQ(right, (std::array<int, 4>{200, 200, 200, 200}));
}

// What a fault outside a copy does; in separate processes, because handlers stay installed.
class GuardedCopyDeathTest : public testing::Test {
 protected:
  GuardedCopyDeathTest() { GTEST_FLAG_SET(death_test_style, "threadsafe"); }

  static void fault_after_a_copy() {
    NumberedFile file(kFileBytes);
    const Mapping mapping(file);
    std::byte out{};
    guarded_copy(&out, mapping.bytes(), 1);
    file.cut_to(0);
    if (guarded_copy(&out, mapping.bytes(), 1)) _exit(1);
    const volatile std::byte* const gone = mapping.bytes();
    out = *gone;
    _exit(2);  // must not be reached
  }
};

TEST_F(GuardedCopyDeathTest, AFaultElsewhereReachesTheHandlerThatWasThereBefore) {
  EXPECT_EXIT(
      {
        ::signal(SIGBUS, [](int) { _exit(42); });
        fault_after_a_copy();
      },
      testing::ExitedWithCode(42), "");
  EXPECT_EXIT(
      {
        struct sigaction action = {};
        action.sa_flags = SA_SIGINFO;
        action.sa_sigaction = [](int, siginfo_t* info, void*) {
          _exit(info->si_addr != nullptr ? 43 : 44);
        };
        ::sigaction(SIGBUS, &action, nullptr);
        fault_after_a_copy();
      },
      testing::ExitedWithCode(43), "");
}

TEST_F(GuardedCopyDeathTest, AFaultElsewhereEndsAProcessWithoutHandler) {
  EXPECT_EXIT(
      {
        ::signal(SIGBUS, SIG_DFL);
        fault_after_a_copy();
      },
      testing::KilledBySignal(SIGBUS), "");
}

TEST_F(GuardedCopyDeathTest, ASignalThatWasSentEndsAProcessWithoutHandler) {
  EXPECT_EXIT(
      {
        ::signal(SIGBUS, SIG_DFL);
        const std::byte from{};
        std::byte to;
        guarded_copy(&to, &from, 1);
        ::raise(SIGBUS);
        _exit(2);
      },
      testing::KilledBySignal(SIGBUS), "");
}

}  // namespace
}  // namespace zonepack
