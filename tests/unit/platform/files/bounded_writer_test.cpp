// SPDX-License-Identifier: Apache-2.0
#include "platform/files/bounded_writer.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cerrno>
#include <thread>
#include <vector>

#include "platform/files/descriptor.hpp"
#include "platform/process/clock.hpp"

namespace zonepack {
namespace {

using std::chrono::milliseconds;

class BoundedWriterOf : public testing::Test {
 protected:
  BoundedWriterOf() {
    int ends[2] = {-1, -1};
    EXPECT_EQ(::pipe2(ends, O_CLOEXEC), 0);
    from = Descriptor(ends[0]);
    to = Descriptor(ends[1]);
  }
  std::int64_t ms_since(std::int64_t ns) const { return (monotonic_ns() - ns) / 1'000'000; }

  Descriptor from, to;
  std::atomic<bool> cancelled{false};
  const std::vector<std::byte> much = std::vector<std::byte>(1 << 20);
};

TEST_F(BoundedWriterOf, WritesAllToAReaderThatTakesItsTime) {
  std::size_t got = 0;
  std::thread reader([&] {
    std::vector<std::byte> part(60'000);
    for (ssize_t n = 0; (n = ::read(from.get(), part.data(), part.size())) > 0;) {
      got += static_cast<std::size_t>(n);
      std::this_thread::sleep_for(milliseconds(5));
    }
  });
  EXPECT_TRUE(BoundedWriter(to.get(), cancelled, {milliseconds(5000), milliseconds(60'000)})
                  .write(much)
                  .ok());
  EXPECT_EQ(::fcntl(to.get(), F_GETFL) & O_NONBLOCK, 0) << "as it was";
  to.close();
  reader.join();
  EXPECT_EQ(got, much.size());
}

TEST_F(BoundedWriterOf, GivesUpOnAPipeThatNobodyReads) {
  const std::int64_t began_ns = monotonic_ns();
  BoundedWriter writer(to.get(), cancelled, {milliseconds(100), milliseconds(60'000)});
  EXPECT_EQ(writer.write(much).error(), (Error{ErrorCode::kIo, ETIMEDOUT}));
  EXPECT_GE(ms_since(began_ns), 100);
  EXPECT_LT(ms_since(began_ns), 5000);
}

// A page every 20 ms is progress, but no reason to go on for ever.
TEST_F(BoundedWriterOf, GivesUpOnAReaderThatDrips) {
  std::atomic<bool> stop{false};
  std::thread reader([&] {
    std::vector<std::byte> page(4096);
    while (!stop.load()) {
      (void)!::read(from.get(), page.data(), page.size());
      std::this_thread::sleep_for(milliseconds(20));
    }
  });
  const std::int64_t began_ns = monotonic_ns();
  BoundedWriter writer(to.get(), cancelled, {milliseconds(5000), milliseconds(300)});
  EXPECT_EQ(writer.write(much).error(), (Error{ErrorCode::kIo, ETIMEDOUT}));
  EXPECT_LT(ms_since(began_ns), 4000);
  stop.store(true);
  to.close();
  reader.join();
}

TEST_F(BoundedWriterOf, EndsWhenItIsCancelled) {
  std::thread canceller([&] {
    std::this_thread::sleep_for(milliseconds(50));
    cancelled.store(true);
  });
  BoundedWriter writer(to.get(), cancelled, {milliseconds(20'000), milliseconds(60'000)});
  const std::int64_t began_ns = monotonic_ns();
  EXPECT_EQ(writer.write(much).error().code, ErrorCode::kCancelled);
  EXPECT_LT(ms_since(began_ns), 5000);
  canceller.join();
}

}  // namespace
}  // namespace zonepack
