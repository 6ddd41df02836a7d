// SPDX-License-Identifier: Apache-2.0
#include "runtime/serve/server.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <limits>

#include "platform/process/clock.hpp"
#include "tests/unit/runtime/serve/served.hpp"

namespace zonepack {
namespace {

using testing_support::Client;
using testing_support::Meanwhile;
using testing_support::Served;
using testing_support::Serving;
using testing_support::soon;
using wire::Fault;

TEST_F(Served, WelcomesAClientWithItsMapAndDescriptors) {
  int ends[2];
  ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
  run.ports.memory_fd = ends[0];
  run.catalog.lineage[0] = 7;
  ASSERT_TRUE(run.open());
  const Serving serving(run);
  Client client(run.settings.socket);
  ASSERT_TRUE(client.connected());
  const wire::Welcome& welcome = client.connection().welcome();
  EXPECT_EQ(welcome.version(), kProtocolVersion);
  EXPECT_EQ(welcome.zones(), 3u);
  EXPECT_EQ(welcome.signatures(), 30u);
  EXPECT_EQ(welcome.lineage()->Get(0), 7);
  EXPECT_EQ(welcome.lease_ns(), run.ports.lease_ns);
  const int memory = client.connection().descriptor(wire::FdKind::Memory);
  struct stat mine, theirs;
  ASSERT_EQ(::fstat(memory, &theirs), 0);
  ASSERT_EQ(::fstat(ends[0], &mine), 0);
  EXPECT_EQ(mine.st_ino, theirs.st_ino);
  EXPECT_EQ(client.connection().descriptor(wire::FdKind::Lock), -1);
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST_F(Served, HelloComesFirstAndInAVersionThatIsSpoken) {
  ASSERT_TRUE(run.open());
  const Serving serving(run);
  auto socket = LocalSocket::connect(run.settings.socket);
  ASSERT_TRUE(socket.ok());
  alignas(8) std::byte buffer[4096];
  const auto fault_of_reply_to = [&](std::span<const std::byte> request) {
    EXPECT_TRUE(socket->send(request).ok());
    EXPECT_TRUE(socket->wait(false, 10'000));
    const auto got = socket->receive(buffer);
    const auto reply = check_reply(std::span(buffer, got->bytes));
    return (*reply)->fault();
  };
  MessageBuilder early;
  EXPECT_EQ(fault_of_reply_to(early.request(1, wire::CreateAskStatus(early.builder()))),
            Fault::Hello);
  MessageBuilder hello;
  EXPECT_EQ(fault_of_reply_to(hello.request(2, wire::CreateHello(hello.builder(), 99))),
            Fault::Version);
}

TEST_F(Served, KnowsZonesByTheEventsOfTheRun) {
  ASSERT_TRUE(run.open());
  run.happen(EventKind::kZoneWanted, 0);
  run.load(0, 3);
  run.happen(EventKind::kLoadStarted, 1);
  const Serving serving(run);
  Client client(run.settings.socket);
  const auto& reply = client.ask([](auto& b) { return wire::CreateAskZones(b); });
  const auto& zones = *reply.body_as_Zones()->zones();
  ASSERT_EQ(zones.size(), 3u);
  EXPECT_EQ(zones.Get(0)->name()->str(), "a");
  EXPECT_EQ(zones.Get(0)->state(), wire::ZoneState::Resident);
  EXPECT_EQ(zones.Get(0)->generation(), 3u);
  EXPECT_TRUE(zones.Get(0)->wanted());
  EXPECT_EQ(zones.Get(1)->state(), wire::ZoneState::Filling);
  EXPECT_EQ(zones.Get(2)->state(), wire::ZoneState::Absent);
  EXPECT_EQ(client.status().zones_resident(), 1u);
  EXPECT_EQ(client.status().zones_filling(), 1u);
}

TEST_F(Served, CountsWhatHappenedToEachZone) {
  ASSERT_TRUE(run.open());
  run.load(1);
  run.happen(EventKind::kZoneEntered, 1);
  run.happen(EventKind::kEvicted, 1);
  const Serving serving(run);
  Client client(run.settings.socket);
  // Only b, of three zones; and nothing from behind it.
  const auto& reply = client.ask([](auto& b) { return wire::CreateAskZones(b, 0, true); });
  const auto& zones = *reply.body_as_Zones()->zones();
  ASSERT_EQ(zones.size(), 1u);
  EXPECT_EQ(zones.Get(0)->zone(), 1u);
  EXPECT_EQ(zones.Get(0)->loads_total(), 1u);
  EXPECT_EQ(zones.Get(0)->evictions_total(), 1u);
  EXPECT_EQ(zones.Get(0)->entered_total(), 1u);
  const auto& none = client.ask([](auto& b) { return wire::CreateAskZones(b, 2, true); });
  EXPECT_EQ(none.body_as_Zones()->zones()->size(), 0u);
}

TEST_F(Served, GivesTheOutlinesOfZonesWithNoMorePointsThanFit) {
  run.catalog.zones[0].polygon.outer = {{0, 0}, {4, 0}, {4, 2.5}};
  for (int i = 0; i < 300; ++i) run.catalog.zones[2].polygon.outer.push_back({double(i), 0});
  ASSERT_TRUE(run.open());
  const Serving serving(run);
  Client client(run.settings.socket);
  const auto& reply = client.ask([](auto& b) { return wire::CreateAskOutlines(b, 0); });
  const wire::Outlines& all = *reply.body_as_Outlines();
  EXPECT_EQ(all.total(), 3u);
  ASSERT_EQ(all.outlines()->size(), 3u);
  ASSERT_EQ(all.outlines()->Get(0)->points()->size(), 3u);
  EXPECT_EQ(all.outlines()->Get(0)->points()->Get(2)->y(), 2.5f);
  EXPECT_EQ(all.outlines()->Get(1)->points()->size(), 0u);
  // 300 points are over 128 and over 256: every third one.
  EXPECT_EQ(all.outlines()->Get(2)->points()->size(), 100u);
  EXPECT_EQ(all.outlines()->Get(2)->points()->Get(1)->x(), 3.0f);
}

TEST_F(Served, ReportsWhatChangedSinceAGivenPoint) {
  ASSERT_TRUE(run.open());
  run.load(0);
  run.load(1);
  const Serving serving(run);
  Client client(run.settings.socket);
  const auto changes_since = [&](std::uint64_t since) -> const wire::Changes& {
    return *client.ask([&](auto& b) { return wire::CreateAskChanges(b, since); }).body_as_Changes();
  };
  const std::uint64_t after_two = changes_since(0).counter();
  EXPECT_EQ(after_two, 2u);
  run.happen(EventKind::kEvicted, 0);
  run.load(2);
  ASSERT_TRUE(soon([&] { return changes_since(0).counter() == 4; }));
  const wire::Changes& changes = changes_since(after_two);
  ASSERT_EQ(changes.changes()->size(), 2u);
  EXPECT_EQ(changes.changes()->Get(0)->zone(), 0u);
  EXPECT_FALSE(changes.changes()->Get(0)->resident());
  EXPECT_EQ(changes.changes()->Get(1)->zone(), 2u);
  EXPECT_TRUE(changes.changes()->Get(1)->resident());
  EXPECT_FALSE(changes.more());
  EXPECT_EQ(changes_since(4).changes()->size(), 0u);
  EXPECT_TRUE(changes_since(1000).restarted()) << "a point that never was";
}

TEST_F(Served, TakesCommandsToTheControlThreadAndItsReplyBack) {
  ASSERT_TRUE(run.open());
  const Meanwhile controlling(control([](const Command& command) {
    CommandReply reply;
    if (command.zone == 2) reply.error = {ErrorCode::kNoRoom, 0};
    return reply;
  }));
  const Serving serving(run);
  Client client(run.settings.socket);
  EXPECT_EQ(client.pin("b").fault(), Fault::None);
  EXPECT_EQ(client.pin("c").fault(), Fault::NoRoom);
  EXPECT_EQ(client.status().zones_pinned(), 1u);
  const wire::Reply& unknown = client.pin("x");
  EXPECT_EQ(unknown.fault(), Fault::NotFound);
  EXPECT_EQ(unknown.text()->str(), "no zone \"x\" in this map");
}

TEST_F(Served, ReleasesTheLeasesOfAClientThatIsGone) {
  ASSERT_TRUE(run.open());
  std::atomic<int> released{0};
  const Meanwhile controlling(control([&](const Command& command) {
    CommandReply reply;
    if (command.kind == Command::Kind::kLease)
      reply.lease = {.zone = command.zone, .generation = 5, .epoch = 1};
    if (command.kind == Command::Kind::kRelease && command.lease.generation == 5) ++released;
    return reply;
  }));
  const Serving serving(run);
  Client watcher(run.settings.socket);
  {
    Client reader(run.settings.socket);
    const wire::Reply& granted = reader.lease(1);
    ASSERT_NE(granted.body_as_Granted(), nullptr);
    EXPECT_EQ(granted.body_as_Granted()->lease()->generation(), 5u);
    EXPECT_EQ(granted.body_as_Granted()->lasts_ns(), run.ports.lease_ns);
    EXPECT_EQ(watcher.status().leases(), 1u);
    const wire::Lease of_another(2, 5, 1);
    EXPECT_EQ(reader.ask([&](auto& b) { return wire::CreateRelease(b, &of_another); }).fault(),
              Fault::NotFound);
    EXPECT_EQ(released.load(), 0);
  }
  EXPECT_TRUE(soon([&] { return released.load() == 1; }));
  EXPECT_EQ(watcher.status().leases(), 0u);
}

TEST_F(Served, HandsOverPosesOnTheRunsClock) {
  LiveStatus status;
  status.now_ns = 1'000'000'000'000'000;  // a log of another day
  status.began_ns = monotonic_ns();
  status.clock_offset_ns = 1'000;
  run.status.store(status);
  ASSERT_TRUE(run.open());
  const Serving serving(run);
  Client client(run.settings.socket);
  const auto give = [&](double x, double variance, wire::Clock clock = wire::Clock::Realtime,
                        std::int64_t stamp_ns = 5'000) {
    return client
        .ask([&](auto& b) {
          const wire::Pose pose(x, 2, 7);
          const wire::Covariance covariance(variance, 0, 0, 0.25, 0, 0.01);
          return wire::CreateGivePose(b, clock, stamp_ns, &pose, &covariance);
        })
        .fault();
  };
  EXPECT_EQ(give(1, 0.04), Fault::None);
  PoseCorrection correction;
  ASSERT_TRUE(run.poses.pop(correction));
  EXPECT_EQ(correction.stamp_ns, 4'000);
  EXPECT_EQ(correction.T_map_base.x_m, 1);
  EXPECT_NEAR(correction.T_map_base.yaw_rad, 7 - 2 * M_PI, 1e-12);
  EXPECT_DOUBLE_EQ(correction.sigma_x_m, 0.2);
  EXPECT_DOUBLE_EQ(correction.sigma_y_m, 0.5);
  EXPECT_EQ(give(std::numeric_limits<double>::quiet_NaN(), 0.04), Fault::Malformed);
  EXPECT_EQ(give(1, 0), Fault::Malformed);
  EXPECT_FALSE(run.poses.pop(correction));
  // Seen 5 us after the cycle began, whatever day the run's clock has.
  EXPECT_EQ(give(1, 0.04, wire::Clock::Monotonic, status.began_ns + 5'000), Fault::None);
  ASSERT_TRUE(run.poses.pop(correction));
  EXPECT_EQ(correction.stamp_ns, status.now_ns + 5'000);
  EXPECT_GE(correction.received_ns, correction.stamp_ns);
}

TEST_F(Served, SendsAPoseAtOnceHoweverLowItsRate) {
  ASSERT_TRUE(run.open());
  const Serving serving(run);
  Client client(run.settings.socket);
  int poses = 0;
  client.connection().on_notice([&](const wire::Reply& reply) {
    if (reply.body_as_PoseReport() != nullptr) ++poses;
  });
  const auto subscribed =
      client.ask([](auto& b) { return wire::CreateSubscribe(b, false, 1e-30F); }).fault();
  EXPECT_EQ(subscribed, Fault::None);
  EXPECT_TRUE(soon([&] { return client.connection().listen(10) && poses == 1; }));
  const auto another = client.connection().listen(100);
  EXPECT_TRUE(another && !*another) << "the next is due in a day";
}

TEST_F(Served, PlansThroughZonesThatAreNotLoadedAndHintsWhenAsked) {
  LiveStatus status;
  status.state.zone = 0;
  status.state.pose.valid = true;
  status.state.pose.T_map_base = {1, 2, 0};
  run.status.store(status);
  ASSERT_TRUE(run.open());
  const Serving serving(run);
  Client client(run.settings.socket);
  // From the robot's position: 3 m to the first door, 4 m to the second.
  const auto& reply =
      client.ask([](auto& b) { return wire::CreateAskRoute(b, kNoZone, 0, 2, 0, true); });
  ASSERT_NE(reply.body_as_Route(), nullptr);
  EXPECT_EQ(reply.body_as_Route()->length(), 7);
  EXPECT_EQ(reply.body_as_Route()->names()->Get(1)->str(), "b");
  EXPECT_TRUE(reply.body_as_Route()->hinted());
  Command command;
  ASSERT_TRUE(run.commands.pop(command));
  EXPECT_EQ(command.kind, Command::Kind::kRouteHint);
  EXPECT_EQ(command.route_length, 3u);
  EXPECT_EQ(command.route[2], 2u);
}

TEST_F(Served, WritesARecordingToTheDescriptorThatCameWithTheRequest) {
  run.ports.dump = [](BoundedWriter& to) -> Result<std::uint64_t> {
    if (const auto written = to.write(std::as_bytes(std::span("frames", 6))); !written) {
      return written.error();
    }
    return std::uint64_t{6};
  };
  ASSERT_TRUE(run.open());
  const Serving serving(run);
  Client client(run.settings.socket);
  int ends[2];
  ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
  const int to[] = {ends[1]};
  const auto dump = [](auto& b) { return wire::CreateDump(b); };
  const wire::Reply& reply = client.ask(dump, to);
  ASSERT_NE(reply.body_as_Dumped(), nullptr);
  EXPECT_EQ(reply.body_as_Dumped()->bytes(), 6u);
  char text[7] = {};
  EXPECT_EQ(::read(ends[0], text, 6), 6);
  EXPECT_STREQ(text, "frames");
  EXPECT_EQ(client.ask(dump).fault(), Fault::Malformed) << "without a descriptor";
  ::close(ends[0]);
  ::close(ends[1]);
}

}  // namespace
}  // namespace zonepack
