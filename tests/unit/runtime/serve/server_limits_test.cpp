// SPDX-License-Identifier: Apache-2.0
// What clients may not do, and what none of them holds up.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>

#include "platform/process/clock.hpp"
#include "runtime/serve/server.hpp"
#include "tests/unit/runtime/serve/served.hpp"

namespace zonepack {
namespace {

using testing_support::Client;
using testing_support::FakeRun;
using testing_support::Served;
using testing_support::Serving;
using testing_support::soon;
using wire::Fault;

TEST_F(Served, SaysBusyWhenTheControlThreadTakesNoCommands) {
  ASSERT_TRUE(run.open());
  const Serving serving(run);
  auto socket = Client(run.settings.socket);
  Command command;
  while (run.commands.push(command)) {
  }
  EXPECT_EQ(socket.pin("a").fault(), Fault::Busy);
}

// A pipe that nobody reads, and a client that makes its descriptor block again: neither holds up
// the end of the service, and the one in time fails with a reason.
TEST_F(Served, ADescriptorThatTakesNothingHoldsNothingUp) {
  for (const bool blocking_again : {false, true}) {
    FakeRun own;
    int ends[2];
    ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
    std::atomic<int> written{0};
    own.ports.dump = [&](BoundedWriter& to) -> Result<std::uint64_t> {
      if (blocking_again) ::fcntl(ends[1], F_SETFL, O_WRONLY);
      const std::vector<std::byte> part(4096);
      for (;;) {
        if (const auto done = to.write(part); !done) return done.error();
        ++written;
      }
    };
    ASSERT_TRUE(own.open());
    {
      const Serving serving(own);
      auto socket = LocalSocket::connect(own.settings.socket);
      MessageBuilder hello, dump;
      ASSERT_TRUE(
          socket->send(hello.request(1, wire::CreateHello(hello.builder(), kProtocolVersion)))
              .ok());
      const int to[] = {ends[1]};
      ASSERT_TRUE(socket->send(dump.request(2, wire::CreateDump(dump.builder())), to).ok());
      ASSERT_TRUE(soon([&] { return written.load() >= 16; }));  // the pipe holds 64 KiB
      Client client(own.settings.socket);
      EXPECT_EQ(client.status().zones(), 3u);
    }
    const std::int64_t began_ns = monotonic_ns();
    EXPECT_TRUE(own.server->stop_dump(began_ns + 2'000'000'000)) << blocking_again;
    EXPECT_LT(monotonic_ns() - began_ns, 2'000'000'000);
    ::close(ends[0]);
    ::close(ends[1]);
  }
}

TEST_F(Served, AHelloIsAnsweredWithDescriptorsOnce) {
  int ends[2];
  ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
  run.ports.memory_fd = ends[0];
  run.ports.presence_fd = ends[0];
  ASSERT_TRUE(run.open());
  const Serving serving(run);
  auto socket = LocalSocket::connect(run.settings.socket);
  alignas(8) std::byte buffer[4096];
  for (const std::size_t descriptors : {2u, 0u, 0u}) {
    MessageBuilder hello;
    ASSERT_TRUE(
        socket->send(hello.request(1, wire::CreateHello(hello.builder(), kProtocolVersion))).ok());
    ASSERT_TRUE(socket->wait(false, 10'000));
    const auto got = socket->receive(buffer);
    ASSERT_TRUE(got.ok());
    EXPECT_EQ(got->descriptor_count, descriptors);
    const auto reply = check_reply(std::span(buffer, got->bytes));
    EXPECT_EQ((*reply)->fault(), descriptors > 0 ? Fault::None : Fault::Malformed);
  }
  ::close(ends[0]);
  ::close(ends[1]);
}

// However little a client may ask: what is within its allowance is no throttling.
TEST_F(Served, AFirstRequestIsNotThrottled) {
  for (const std::uint32_t requests_per_s : {1u, 500u}) {
    FakeRun own;
    own.settings.requests_per_s = requests_per_s;
    ASSERT_TRUE(own.open());
    {
      const Serving serving(own);
      for (int i = 0; i < 5; ++i) {
        auto socket = LocalSocket::connect(own.settings.socket);
        MessageBuilder hello;
        const auto request = hello.request(1, wire::CreateHello(hello.builder(), kProtocolVersion));
        ASSERT_TRUE(socket->send(request).ok());
        ASSERT_TRUE(socket->wait(false, 10'000));
        std::this_thread::sleep_for(std::chrono::milliseconds(25));  // two turns
      }
    }
    EXPECT_EQ(own.server->counters().throttled, 0u);
  }
}

TEST_F(Served, TheLookingSocketIsForLookingOnly) {
  run.settings.looking_socket = run.folder / "look";
  ASSERT_TRUE(run.open());
  struct stat status;
  ASSERT_EQ(::stat(run.settings.socket.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0660u);
  ASSERT_EQ(::stat(run.settings.looking_socket.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0666u);
  const Serving serving(run);
  Client client(run.settings.looking_socket);
  EXPECT_TRUE(client.connection().welcome().looking_only());
  EXPECT_EQ(client.status().zones(), 3u);
  EXPECT_EQ(client.pin("a").fault(), Fault::Denied);
  EXPECT_EQ(client.lease(0).fault(), Fault::Denied);
  EXPECT_EQ(client.ask([](auto& b) { return wire::CreateAskRoute(b, 0, 0, 2, 0, true); }).fault(),
            Fault::Denied);
}

TEST_F(Served, OpeningSaysWhatPreventsIt) {
  ASSERT_TRUE(run.open());
  const auto fault_of = [&](const ServeSettings& settings) {
    const auto opened = Server::open(settings, run.ports, run.catalog, run.graph, {});
    EXPECT_FALSE(opened.ok());
    return opened.error().message;
  };
  const std::string taken = fault_of(run.settings);
  EXPECT_NE(taken.find(run.settings.socket), std::string::npos);
  EXPECT_NE(taken.find("another zoned listens there"), std::string::npos);
  ServeSettings settings;
  settings.socket = run.folder / "t";
  settings.mode = "0x1";
  EXPECT_NE(fault_of(settings).find("expected octal digits"), std::string::npos);
  settings.mode = "0660";
  settings.group = "no such group";
  EXPECT_NE(fault_of(settings).find("group \"no such group\": there is no such group"),
            std::string::npos);
  settings.group.clear();
  settings.socket = run.folder / "no/such/folder";
  settings.mode = "0660";
  EXPECT_NE(fault_of(settings).find("No such file or directory"), std::string::npos);
}

}  // namespace
}  // namespace zonepack
