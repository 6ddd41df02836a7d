// SPDX-License-Identifier: Apache-2.0
#include "platform/files/file_lock.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <optional>

#include "tests/support/temporary_folder.hpp"

namespace zonepack {
namespace {

using std::chrono::milliseconds;

class Lock : public testing::Test {
 protected:
  test_support::TemporaryFolder folder;
  const std::string path = folder / "lock";

  FileLock locked() {
    Result<FileLock> lock = FileLock::acquire(path, milliseconds(0));
    EXPECT_TRUE(lock.ok());
    return std::move(*lock);
  }
};

TEST_F(Lock, IsRefusedWhileAnotherHoldsIt) {
  std::optional<FileLock> first(locked());
  EXPECT_EQ(FileLock::acquire(path, milliseconds(40)).error().code, ErrorCode::kBusy);
  first.reset();
  EXPECT_TRUE(FileLock::acquire(path, milliseconds(0)).ok());
}

TEST_F(Lock, LastsAsLongAsAnyShareOfIt) {
  std::optional<FileLock> lock(locked());
  Result<Descriptor> share = lock->file().share();
  lock.reset();
  EXPECT_EQ(FileLock::acquire(path, milliseconds(0)).error().code, ErrorCode::kBusy);
  share->close();
  EXPECT_TRUE(FileLock::acquire(path, milliseconds(0)).ok());
}

TEST_F(Lock, EndsWithAKilledProcess) {
  std::optional<FileLock> lock(locked());
  const pid_t holder = fork();
  if (holder == 0) {
    for (;;) pause();
  }
  lock.reset();
  EXPECT_FALSE(FileLock::acquire(path, milliseconds(0)).ok());
  kill(holder, SIGKILL);
  waitpid(holder, nullptr, 0);
  EXPECT_TRUE(FileLock::acquire(path, milliseconds(0)).ok());
}

TEST_F(Lock, TakesBackAShareOfItsOwnButNotAnothers) {
  const FileLock lock = locked();
  Result<Descriptor> share = lock.file().share();
  EXPECT_TRUE(FileLock::adopt(std::move(*share)).ok());
  // A file opened by itself shares nothing.
  Descriptor other(open(path.c_str(), O_RDONLY));
  EXPECT_EQ(FileLock::adopt(std::move(other)).error().code, ErrorCode::kBusy);
}

TEST_F(Lock, SaysWhyItCannotMakeItsFile) {
  EXPECT_EQ(FileLock::acquire(path + "/none", milliseconds(0)).error(),
            (Error{ErrorCode::kIo, ENOENT}));
}

}  // namespace
}  // namespace zonepack
