// SPDX-License-Identifier: Apache-2.0
#include "platform/process/notify.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>

#include "tests/support/temporary_folder.hpp"

namespace zonepack {
namespace {

// A service manager: a socket that notifications are sent to.
class Manager {
 public:
  // An address that begins with '@' is abstract.
  explicit Manager(std::string address) : socket_(socket(AF_UNIX, SOCK_DGRAM, 0)) {
    setenv("NOTIFY_SOCKET", address.c_str(), 1);
    if (address[0] == '@') address[0] = '\0';
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    std::memcpy(name.sun_path, address.data(), address.size());
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + address.size());
    EXPECT_EQ(bind(socket_.get(), reinterpret_cast<sockaddr*>(&name), size), 0);
  }
  ~Manager() { unsetenv("NOTIFY_SOCKET"); }

  // The next notification, and the file that came with it.
  std::string receive(Descriptor* file = nullptr) {
    char text[512];
    iovec part{text, sizeof text};
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    const ssize_t size = recvmsg(socket_.get(), &message, MSG_DONTWAIT);
    if (size < 0) return "nothing";
    if (const cmsghdr* header = CMSG_FIRSTHDR(&message); header != nullptr && file != nullptr) {
      int number = -1;
      std::memcpy(&number, CMSG_DATA(header), sizeof number);
      *file = Descriptor(number);
    }
    return {text, static_cast<std::size_t>(size)};
  }

 private:
  Descriptor socket_;
};

TEST(Notify, ReportsTheStateOfTheServiceToTheManager) {
  const test_support::TemporaryFolder folder;
  Manager manager(folder / "notify");
  const auto notifier = Notifier::from_environment();
  ASSERT_TRUE(notifier.ok());
  EXPECT_TRUE(notifier->has_manager());
  EXPECT_TRUE(notifier->ready().ok());
  EXPECT_EQ(manager.receive(), "READY=1");
  EXPECT_TRUE(notifier->status("zone H1, 3 of 8 MiB\nREADY=0").ok());
  EXPECT_EQ(manager.receive(), "STATUS=zone H1, 3 of 8 MiB");
  EXPECT_TRUE(notifier->alive().ok());
  EXPECT_EQ(manager.receive(), "WATCHDOG=1");
  EXPECT_TRUE(notifier->reloading().ok());
  EXPECT_EQ(manager.receive().substr(0, 27), "RELOADING=1\nMONOTONIC_USEC=");
  EXPECT_TRUE(notifier->stopping().ok());
  EXPECT_EQ(manager.receive(), "STOPPING=1");
}

TEST(Notify, ReachesAManagerWithAnAbstractAddress) {
  Manager manager("@zonepack-notify-test-" + std::to_string(getpid()));
  EXPECT_TRUE(Notifier::from_environment()->ready().ok());
  EXPECT_EQ(manager.receive(), "READY=1");
}

TEST(Notify, GivesTheManagerAnOpenFileToKeep) {
  const test_support::TemporaryFolder folder;
  Manager manager(folder / "notify");
  const Descriptor file(open((folder / "kept").c_str(), O_RDWR | O_CREAT, 0600));
  const auto notifier = Notifier::from_environment();
  EXPECT_TRUE(notifier->keep("arena", file).ok());
  Descriptor kept;
  EXPECT_EQ(manager.receive(&kept), "FDSTORE=1\nFDNAME=arena");
  struct stat given {
  }, received{};
  ASSERT_EQ(fstat(file.get(), &given), 0);
  ASSERT_EQ(fstat(kept.get(), &received), 0);
  EXPECT_EQ(received.st_ino, given.st_ino);
  EXPECT_TRUE(notifier->forget("arena").ok());
  EXPECT_EQ(manager.receive(), "FDSTOREREMOVE=1\nFDNAME=arena");
}

TEST(Notify, WithoutAManagerDoesNothing) {
  unsetenv("NOTIFY_SOCKET");
  const auto notifier = Notifier::from_environment();
  ASSERT_TRUE(notifier.ok());
  EXPECT_FALSE(notifier->has_manager());
  EXPECT_TRUE(notifier->ready().ok());
}

TEST(Notify, SaysWhenTheManagerIsGone) {
  const test_support::TemporaryFolder folder;
  const auto notifier = [&] {
    const Manager manager(folder / "notify");
    return Notifier::from_environment();
  }();
  EXPECT_EQ(notifier->ready().error(), (Error{ErrorCode::kIo, ECONNREFUSED}));
}

TEST(Notify, IsWatchedOnlyIfTheVariableIsMeantForThisProcess) {
  Manager manager("@zonepack-watchdog-test-" + std::to_string(getpid()));
  setenv("WATCHDOG_USEC", "2000000", 1);
  EXPECT_EQ(Notifier::from_environment()->watchdog(), std::chrono::seconds(2));
  setenv("WATCHDOG_PID", "1", 1);
  EXPECT_EQ(Notifier::from_environment()->watchdog(), std::chrono::seconds(0));
  unsetenv("WATCHDOG_PID");
  setenv("WATCHDOG_USEC", "soon", 1);
  EXPECT_EQ(Notifier::from_environment()->watchdog(), std::chrono::seconds(0));
  unsetenv("WATCHDOG_USEC");
}

// In a child, whose descriptors from 3 on are as the manager leaves them.
int take_in_child(const char* pid) {
  const pid_t child = fork();
  if (child != 0) {
    int status = 0;
    waitpid(child, &status, 0);
    return WEXITSTATUS(status);
  }
  const int file = open("/dev/null", O_RDONLY);
  dup2(file, 3);
  dup2(file, 4);
  setenv("LISTEN_PID", pid == nullptr ? std::to_string(getpid()).c_str() : pid, 1);
  setenv("LISTEN_FDS", "2", 1);
  setenv("LISTEN_FDNAMES", "arena:lock", 1);
  const std::vector<HandedFile> handed = take_handed_files();
  if (getenv("LISTEN_FDS") != nullptr) _exit(100);
  if (handed.size() == 2 &&
      (handed[0].name != "arena" || handed[1].name != "lock" || handed[1].file.get() != 4)) {
    _exit(101);
  }
  _exit(static_cast<int>(handed.size()));
}

TEST(HandedFiles, ComeWithTheirNames) { EXPECT_EQ(take_in_child(nullptr), 2); }

TEST(HandedFiles, OfAnotherProcessAreLeftAlone) { EXPECT_EQ(take_in_child("1"), 0); }

}  // namespace
}  // namespace zonepack
