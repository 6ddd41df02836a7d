// SPDX-License-Identifier: Apache-2.0
#include "platform/memory/shared_memory.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <functional>

#include "platform/process/realtime.hpp"

namespace zonepack {
namespace {

constexpr ByteCount kSharedBytes = 64 * kKiB;

SharedMemory make() {
  auto memory = SharedMemory::create("zonepack-test", kSharedBytes);
  EXPECT_TRUE(memory.ok());
  return std::move(*memory);
}

// The exit code of a child process that runs `body`.
int in_child(const std::function<int()>& body) {
  const pid_t child = fork();
  if (child == 0) _exit(body());
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST(SharedMemory, ShowsReadersWhatTheWriterWrites) {
  SharedMemory memory = make();
  auto reader = SharedMemory::map_read_only(memory.reader_file().value());
  ASSERT_TRUE(reader.ok());
  ASSERT_EQ(reader->read_only().size(), kSharedBytes);
  memory.bytes()[kSharedBytes - 1] = std::byte{42};
  EXPECT_EQ(reader->read_only()[kSharedBytes - 1], std::byte{42});
}

TEST(SharedMemory, CannotBeMappedWritableByAReader) {
  const SharedMemory memory = make();
  const auto file = memory.reader_file();
  ASSERT_TRUE(file.ok());
  errno = 0;
  EXPECT_EQ(mmap(nullptr, kSharedBytes, PROT_READ | PROT_WRITE, MAP_SHARED, file->get(), 0),
            MAP_FAILED);
  EXPECT_EQ(errno, EACCES);
  void* const mapped = mmap(nullptr, kSharedBytes, PROT_READ, MAP_SHARED, file->get(), 0);
  ASSERT_NE(mapped, MAP_FAILED);
  EXPECT_NE(mprotect(mapped, kSharedBytes, PROT_READ | PROT_WRITE), 0);
  EXPECT_EQ(errno, EACCES);
  munmap(mapped, kSharedBytes);
  EXPECT_LT(write(file->get(), "x", 1), 0);
}

TEST(SharedMemory, CannotBeReopenedForWritingByAnotherUser) {
  if (getuid() != 0) GTEST_SKIP() << "changing the user takes root";
  const SharedMemory memory = make();
  const auto file = memory.reader_file();
  const std::string path = "/proc/self/fd/" + std::to_string(file->get());
  EXPECT_EQ(in_child([&] {
              if (setgid(65534) != 0 || setuid(65534) != 0) return 1;
              if (open(path.c_str(), O_RDWR) >= 0) return 2;
              if (fchmod(file->get(), 0600) == 0) return 3;
              return errno == EPERM ? 0 : 4;
            }),
            0);
}

TEST(SharedMemory, NeverChangesItsSize) {
  const SharedMemory memory = make();
  EXPECT_NE(ftruncate(memory.file().get(), 0), 0);
  EXPECT_EQ(errno, EPERM);
  EXPECT_NE(ftruncate(memory.file().get(), 2 * kSharedBytes), 0);
}

// Not under sanitizers, which would also touch pages of their own.
__attribute__((no_sanitize("thread", "address", "undefined"))) void touch_pages(std::byte* begin,
                                                                                std::size_t size) {
  for (std::size_t at = 0; at < size; at += 4096) begin[at] = std::byte{1};
}

TEST(SharedMemory, HasAllItsPagesFromTheStart) {
  SharedMemory memory = make();
  std::byte elsewhere{};
  touch_pages(&elsewhere, 1);  // the pages of its code, and of the count's
  thread_usage();
  const ThreadUsage before = thread_usage();
  touch_pages(memory.bytes().data(), memory.bytes().size());
  EXPECT_EQ(thread_usage().minor_faults, before.minor_faults);
}

TEST(SharedMemory, IsTakenOverWithItsContentByTheNextWriter) {
  SharedMemory memory = make();
  memory.bytes()[7] = std::byte{9};
  const auto reader = SharedMemory::map_read_only(memory.reader_file().value());
  auto kept = memory.file().share();
  { const SharedMemory ended(std::move(memory)); }
  auto next = SharedMemory::adopt(std::move(*kept), kSharedBytes);
  ASSERT_TRUE(next.ok());
  EXPECT_EQ(next->bytes()[7], std::byte{9});
  next->bytes()[7] = std::byte{10};
  EXPECT_EQ(reader->read_only()[7], std::byte{10});
}

TEST(SharedMemory, RefusesMemoryOfAnotherSizeAndFilesThatCanShrink) {
  const SharedMemory memory = make();
  EXPECT_EQ(SharedMemory::adopt(memory.file().share().value(), kSharedBytes - 1).error(),
            (Error{ErrorCode::kMismatch, kSharedBytes}));
  Descriptor loose(memfd_create("loose", MFD_CLOEXEC));
  ASSERT_EQ(ftruncate(loose.get(), kSharedBytes), 0);
  EXPECT_EQ(SharedMemory::map_read_only(std::move(loose)).error().code, ErrorCode::kMismatch);
}

}  // namespace
}  // namespace zonepack
