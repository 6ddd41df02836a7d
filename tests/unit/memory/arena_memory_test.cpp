// SPDX-License-Identifier: Apache-2.0
#include "runtime/memory/arena_memory.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <optional>

#include "tests/support/temporary_folder.hpp"

namespace zonepack {
namespace {

using std::chrono::milliseconds;

// A service manager that keeps the files it is sent.
class Manager {
 public:
  explicit Manager(const std::string& path) : socket_(socket(AF_UNIX, SOCK_DGRAM, 0)) {
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    std::memcpy(name.sun_path, path.c_str(), path.size() + 1);
    EXPECT_EQ(bind(socket_.get(), reinterpret_cast<sockaddr*>(&name), sizeof name), 0);
    setenv("NOTIFY_SOCKET", path.c_str(), 1);
    notifier = Notifier::from_environment().value();
    unsetenv("NOTIFY_SOCKET");
  }

  // What it would hand to a zoned that is started now.
  std::vector<HandedFile> hand_over() {
    char text[256];
    for (;;) {
      iovec part{text, sizeof text};
      alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
      msghdr message{};
      message.msg_iov = &part, message.msg_iovlen = 1;
      message.msg_control = control, message.msg_controllen = sizeof control;
      const ssize_t size = recvmsg(socket_.get(), &message, MSG_DONTWAIT);
      if (size < 0) break;
      const std::string said(text, static_cast<std::size_t>(size));
      const std::string name = said.substr(said.find("FDNAME=") + 7);
      if (said.starts_with("FDSTORE=1")) {
        int number = -1;
        std::memcpy(&number, CMSG_DATA(CMSG_FIRSTHDR(&message)), sizeof number);
        kept_.push_back({name, Descriptor(number)});
      } else {
        std::erase_if(kept_, [&](const HandedFile& file) { return file.name == name; });
      }
    }
    std::vector<HandedFile> shares;
    for (const HandedFile& file : kept_) {
      shares.push_back({file.name, file.file.share().value()});
    }
    return shares;
  }

  Notifier notifier;

 private:
  Descriptor socket_;
  std::vector<HandedFile> kept_;
};

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
  Manager manager(folder / "notify");
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
  // And once more: the manager still keeps it.
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
  Manager manager(folder / "notify");
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
