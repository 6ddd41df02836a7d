// SPDX-License-Identifier: Apache-2.0
#include "runtime/memory/arena_memory.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <optional>

#include "tests/support/service_manager.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack {
namespace {

using std::chrono::milliseconds;

class ArenaMemoryOf : public testing::Test {
 protected:
  test_support::TemporaryFolder folder;
  ArenaMemory::Source source{folder / "lock", milliseconds(40), nullptr, nullptr};
  static constexpr ByteCount kBytes = 16 * kKiB;

  // A process that maps the memory, as a reader does.
  pid_t attach_reader(const ArenaMemory& arena) {
    Descriptor memory = arena.reader_memory().value();
    const Descriptor lock = arena.reader_lock().value();
    const pid_t reader = fork();
    if (reader != 0) return reader;
    const auto mapped = SharedMemory::map_read_only(std::move(memory));
    for (;;) pause();
  }
  static void end(pid_t reader) {
    kill(reader, SIGKILL);
    waitpid(reader, nullptr, 0);
  }
};

TEST_F(ArenaMemoryOf, AManagedZonedIsTheSameAfterACrashWithReadersAttached) {
  test_support::ServiceManager manager(folder / "notify");
  source.manager = &manager.notifier;
  std::optional<ArenaMemory> first(ArenaMemory::obtain(kBytes, source).value());
  EXPECT_FALSE(first->taken_over());
  first->bytes()[5] = std::byte{77};
  const auto reader = SharedMemory::map_read_only(first->reader_memory().value());
  const Descriptor readers_lock = first->reader_lock().value();
  std::vector<HandedFile> handed = manager.hand_over();
  first.reset();

  source.handed = &handed;
  auto second = ArenaMemory::obtain(kBytes, source);
  ASSERT_TRUE(second.ok());
  EXPECT_TRUE(second->taken_over());
  second->bytes()[6] = std::byte{78};
  EXPECT_EQ(reader->read_only()[5], std::byte{77});
  EXPECT_EQ(reader->read_only()[6], std::byte{78});
  EXPECT_TRUE(handed.empty());
  // And again: the manager still keeps it.
  std::vector<HandedFile> again = manager.hand_over();
  source.handed = &again;
  EXPECT_TRUE(ArenaMemory::obtain(kBytes, source)->taken_over());
}

TEST_F(ArenaMemoryOf, AnUnmanagedZonedIsRefusedWhileReadersHoldTheOldOne) {
  std::optional<ArenaMemory> first(ArenaMemory::obtain(kBytes, source).value());
  const pid_t reader = attach_reader(*first);
  first.reset();
  EXPECT_EQ(ArenaMemory::obtain(kBytes, source).error().code, ErrorCode::kBusy);
  EXPECT_NE(ArenaMemory::why_busy(source).find(source.lock_path), std::string::npos);
  end(reader);
  const auto second = ArenaMemory::obtain(kBytes, source);
  ASSERT_TRUE(second.ok());
  EXPECT_FALSE(second->taken_over());
}

TEST_F(ArenaMemoryOf, AnotherSizeIsNotTakenOverButMadeWhenTheReadersAreGone) {
  test_support::ServiceManager manager(folder / "notify");
  source.manager = &manager.notifier;
  std::optional<ArenaMemory> first(ArenaMemory::obtain(kBytes, source).value());
  const pid_t reader = attach_reader(*first);
  std::vector<HandedFile> handed = manager.hand_over();
  source.handed = &handed;
  first.reset();
  EXPECT_EQ(ArenaMemory::obtain(2 * kBytes, source).error().code, ErrorCode::kBusy);
  end(reader);
  handed = manager.hand_over();
  EXPECT_TRUE(handed.empty());
  auto second = ArenaMemory::obtain(2 * kBytes, source);
  ASSERT_TRUE(second.ok());
  EXPECT_EQ(second->bytes().size(), 2 * kBytes);
}

}  // namespace
}  // namespace zonepack
