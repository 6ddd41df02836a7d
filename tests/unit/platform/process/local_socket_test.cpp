// SPDX-License-Identifier: Apache-2.0
#include "platform/process/local_socket.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "platform/process/poller.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

class LocalSockets : public testing::Test {
 protected:
  test_support::TemporaryFolder folder;
  const std::string path = folder / "s";

  struct Pair {
    LocalSocket client, server;
  };
  static Pair connected(const LocalListener& listener) {
    auto client = LocalSocket::connect(listener.path());
    auto server = listener.accept();
    EXPECT_TRUE(client.ok() && server.ok());
    return {std::move(client).value(), std::move(server).value()};
  }
};

TEST_F(LocalSockets, CarryWholeMessagesBothWaysAndKnowThePeer) {
  const auto listener = LocalListener::listen(path, 0600);
  ASSERT_TRUE(listener.ok());
  Pair pair = connected(*listener);
  EXPECT_EQ(pair.server.peer().pid, ::getpid());
  EXPECT_EQ(pair.server.peer().uid, ::getuid());
  ASSERT_TRUE(pair.client.send(bytes_of("one")).ok());
  ASSERT_TRUE(pair.client.send(bytes_of("two and")).ok());
  std::byte buffer[16];
  EXPECT_EQ(pair.server.receive(buffer)->bytes, 3u);
  const auto second = pair.server.receive(std::span(buffer, 3));
  EXPECT_EQ(second->bytes, 3u);
  EXPECT_TRUE(second->cut) << "a message is never continued by the next receive";
  EXPECT_EQ(pair.server.receive(buffer).error().code, ErrorCode::kBusy);
  pair.client.close();
  EXPECT_EQ(pair.server.receive(buffer)->bytes, 0u);
  EXPECT_EQ(pair.server.send(bytes_of("late")).error().code, ErrorCode::kCancelled);
}

TEST_F(LocalSockets, WhatThePeerSaidLastIsReadThoughItClosedWithoutReading) {
  const auto listener = LocalListener::listen(path, 0600);
  Pair pair = connected(*listener);
  ASSERT_TRUE(pair.client.send(bytes_of("unread")).ok());
  ASSERT_TRUE(pair.server.send(bytes_of("go away")).ok());
  pair.server.close();
  std::byte buffer[16];
  EXPECT_EQ(pair.client.receive(buffer)->bytes, 7u);
  EXPECT_EQ(pair.client.receive(buffer)->bytes, 0u);
}

TEST_F(LocalSockets, HandOverDescriptorsAndKeepNoneBeyondTheirNumber) {
  const auto listener = LocalListener::listen(path, 0600);
  Pair pair = connected(*listener);
  Descriptor file(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  const int twice[] = {file.get(), file.get()};
  ASSERT_TRUE(pair.client.send(bytes_of("m"), twice).ok());
  std::byte buffer[16];
  auto received = pair.server.receive(buffer);
  ASSERT_EQ(received->descriptor_count, 2u);
  EXPECT_NE(received->descriptors[0].get(), file.get());
  struct stat status;
  EXPECT_EQ(::fstat(received->descriptors[1].get(), &status), 0);
}

TEST_F(LocalSockets, SendingNeverWaitsAndIsBounded) {
  const auto listener = LocalListener::listen(path, 0600);
  Pair pair = connected(*listener);
  ASSERT_TRUE(pair.server.limit_output(32 * 1024).ok());
  const std::string kilobyte(1024, 'x');
  int sent = 0;
  while (sent < 1000 && pair.server.send(bytes_of(kilobyte)).ok()) ++sent;
  EXPECT_GE(sent, 4);
  EXPECT_LE(sent, 64);
  EXPECT_EQ(pair.server.send(bytes_of(kilobyte)).error().code, ErrorCode::kBusy);
}

TEST_F(LocalSockets, ListenReplacesOnlyASocketThatNobodyListensOn) {
  {
    auto first = LocalListener::listen(path, 0600);
    ASSERT_TRUE(first.ok());
    EXPECT_EQ(LocalListener::listen(path, 0600).error().code, ErrorCode::kExists);
    EXPECT_TRUE(LocalSocket::connect(path).ok()) << "the first still listens";
    // Killed: the name stays, but no process listens.
    const LocalListener left = std::move(*first);
    ASSERT_EQ(::link(path.c_str(), (path + "2").c_str()), 0);
  }
  EXPECT_EQ(LocalSocket::connect(path).error().code, ErrorCode::kNotFound);
  ASSERT_EQ(::rename((path + "2").c_str(), path.c_str()), 0);
  const auto second = LocalListener::listen(path, 0660);
  ASSERT_TRUE(second.ok());
  struct stat status;
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0660u);
}

TEST_F(LocalSockets, ListenTouchesNoOtherFile) {
  std::ofstream(path) << "data";
  EXPECT_EQ(LocalListener::listen(path, 0600).error().code, ErrorCode::kExists);
  EXPECT_EQ(LocalListener::listen(path + std::string(110, 'x'), 0600).error().code,
            ErrorCode::kTooLarge);
  std::string text;
  std::getline(std::ifstream(path), text);
  EXPECT_EQ(text, "data");
}

TEST_F(LocalSockets, APollerReportsWhichSocketIsReadyAndWhichIsGone) {
  const auto listener = LocalListener::listen(path, 0600);
  auto poller = Poller::create();
  ASSERT_TRUE(poller.ok());
  ASSERT_TRUE(poller->add(listener->fd(), 7, Poller::kReadable).ok());
  Poller::Ready ready[4];
  EXPECT_TRUE(poller->wait(ready, 0).empty());
  auto client = LocalSocket::connect(path);
  auto found = poller->wait(ready, 1000);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].token, 7u);
  auto server = listener->accept();
  ASSERT_TRUE(poller->add(server->fd(), 8, Poller::kNothing).ok());
  ASSERT_TRUE(client->send(bytes_of("m")).ok());
  EXPECT_TRUE(poller->wait(ready, 0).empty()) << "nobody asked for it";
  client->close();
  found = poller->wait(ready, 1000);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].closed);
  server->close();
  poller->wake();
  EXPECT_TRUE(poller->wait(ready, 10'000).empty()) << "returned without anything ready";
}

}  // namespace
}  // namespace zonepack
