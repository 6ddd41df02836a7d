// SPDX-License-Identifier: Apache-2.0
#include "runtime/memory/arena_memory.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
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
  ArenaMemory::Source source{.lock_path = folder / "lock", .wait = milliseconds(40)};
  static constexpr ByteCount kBytes = 16 * kKiB;

  // A process that maps the memory, as a reader does.
  pid_t attach_reader(const ArenaMemory& arena) {
    Descriptor memory = arena.reader_memory().value();
    const Descriptor presence = arena.reader_presence().value();
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
  const Descriptor presence = first->reader_presence().value();
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
  const auto refused = ArenaMemory::obtain(kBytes, source);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::kBusy);
  EXPECT_NE(refused.error().message.find(ArenaMemory::readers_path(source)), std::string::npos);
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

// Whatever a reader does to what it was handed, a second zoned stays out while the first runs, and
// the presence of another reader still shows afterwards.
TEST_F(ArenaMemoryOf, AReaderCanReleaseNothing) {
  std::optional<ArenaMemory> first(ArenaMemory::obtain(kBytes, source).value());
  const pid_t other = attach_reader(*first);
  Descriptor memory = first->reader_memory().value();
  Descriptor presence = first->reader_presence().value();
  for (const Descriptor* const handed : {&memory, &presence}) {
    flock(handed->get(), LOCK_UN);
    struct flock all {};
    all.l_type = F_UNLCK;
    fcntl(handed->get(), F_SETLK, &all);
    fcntl(handed->get(), F_OFD_SETLK, &all);
  }
  EXPECT_EQ(ArenaMemory::obtain(kBytes, source).error().code, ErrorCode::kBusy);
  first.reset();
  presence.close();
  EXPECT_EQ(ArenaMemory::obtain(kBytes, source).error().code, ErrorCode::kBusy);
  end(other);
  EXPECT_TRUE(ArenaMemory::obtain(kBytes, source).ok());
}

TEST_F(ArenaMemoryOf, WhatTakesThePlaceOfItsFilesIsRefusedByName) {
  const std::string target = folder / "target";
  const auto refusal = [&] {
    const auto arena = ArenaMemory::obtain(kBytes, source);
    return arena ? std::string() : arena.error().message;
  };
  const std::string readers = ArenaMemory::readers_path(source);
  const auto link_from = [&](const std::string& path) {
    for (const std::string& own : {source.lock_path, readers}) unlink(own.c_str());
    ASSERT_EQ(symlink(target.c_str(), path.c_str()), 0);
  };
  const auto expect_refused = [&](const std::string& path, const char* kind) {
    const std::string message = refusal();
    EXPECT_NE(message.find(path + ": is " + kind), std::string::npos) << message;
    ASSERT_EQ(unlink(path.c_str()), 0);
  };
  ASSERT_EQ(mkfifo(source.lock_path.c_str(), 0600), 0);
  expect_refused(source.lock_path, "a FIFO");
  for (const std::string& path : {source.lock_path, readers}) {
    link_from(path);
    expect_refused(path, "a symbolic link");
  }
  ASSERT_EQ(mkfifo(target.c_str(), 0600), 0);
  for (const std::string& path : {source.lock_path, readers}) {
    link_from(path);
    expect_refused(path, "a symbolic link");
  }
  close(open(readers.c_str(), O_CREAT | O_WRONLY, 0600));
  expect_refused(readers, "a regular file");
  EXPECT_EQ(refusal(), "");
}

}  // namespace
}  // namespace zonepack
