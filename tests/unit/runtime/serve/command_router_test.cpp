// SPDX-License-Identifier: Apache-2.0
#include "runtime/serve/command_router.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace zonepack {
namespace {

constexpr std::int64_t kLease_ns = 100;

class Desk : public testing::Test {
 protected:
  SpscQueue<Command> commands{8};
  SpscQueue<CommandReply> replies{8};
  ZoneTable zones{4};
  CommandRouter router{commands, replies};
  std::vector<CommandRouter::Settled> told;

  void SetUp() override { router.use(zones, 0); }

  static Command command_of(Command::Kind kind, ZoneId zone = 0) {
    Command command;
    command.kind = kind;
    command.zone = zone;
    return command;
  }
  void settle(std::int64_t monotonic_ns = 0, std::int64_t run_ns = 0) {
    router.settle(monotonic_ns, run_ns, kLease_ns,
                  [this](const CommandRouter::Settled& settled) { told.push_back(settled); });
  }
  // The control thread takes one command and answers it.
  Command answer(ErrorCode code = ErrorCode::kOk) {
    Command command;
    EXPECT_TRUE(commands.pop(command));
    CommandReply reply;
    reply.id = command.id;
    reply.error.code = code;
    if (command.kind == Command::Kind::kLease && code == ErrorCode::kOk) {
      reply.lease = {.zone = command.zone, .generation = 9, .epoch = 1};
    }
    replies.push(reply);
    return command;
  }
};

TEST_F(Desk, RoutesRepliesToTheirClientsInAnyOrder) {
  ASSERT_TRUE(router.post(1, 10, command_of(Command::Kind::kPin, 2), 0).ok());
  ASSERT_TRUE(router.post(2, 20, command_of(Command::Kind::kFreeze), 0).ok());
  answer(ErrorCode::kNoRoom);
  answer();
  settle();
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(told[0].client, 1u);
  EXPECT_EQ(told[0].request_id, 10u);
  EXPECT_EQ(told[0].reply.error.code, ErrorCode::kNoRoom);
  EXPECT_EQ(told[1].client, 2u);
  EXPECT_FALSE(zones[2].pinned) << "refused";
  EXPECT_EQ(router.pending(), 0u);
}

TEST_F(Desk, IsBusyRatherThanWaitingForRoom) {
  for (int i = 0; i < 8; ++i) {
    ASSERT_TRUE(router.post(1, 1, command_of(Command::Kind::kFreeze), 0).ok());
  }
  EXPECT_EQ(router.post(1, 9, command_of(Command::Kind::kFreeze), 0).error().code,
            ErrorCode::kBusy);
  EXPECT_EQ(router.pending(), 8u);
}

TEST_F(Desk, GivesUpAnAnswerThatDoesNotComeAndGivesBackALeaseThatComesLater) {
  ASSERT_TRUE(router.post(1, 10, command_of(Command::Kind::kLease, 3), 0).ok());
  settle(CommandRouter::kPatience_ns - 1);
  EXPECT_TRUE(told.empty());
  settle(CommandRouter::kPatience_ns);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].reply.error.code, ErrorCode::kBusy);
  answer();
  settle(CommandRouter::kPatience_ns);
  Command release;
  ASSERT_TRUE(commands.pop(release));
  EXPECT_EQ(release.kind, Command::Kind::kRelease);
  EXPECT_EQ(release.lease.zone, 3u);
  EXPECT_EQ(router.leases(), 0u);
}

TEST_F(Desk, AClientsEndIsTheEndOfItsLeasesEvenOfOneStillOnItsWay) {
  ASSERT_TRUE(router.post(1, 10, command_of(Command::Kind::kLease, 0), 0).ok());
  ASSERT_TRUE(router.post(1, 11, command_of(Command::Kind::kLease, 1), 0).ok());
  answer();
  settle();
  EXPECT_EQ(zones[0].leases, 1u);
  router.client_gone(1);
  EXPECT_EQ(zones[0].leases, 0u);
  answer();  // zone 1
  settle();
  EXPECT_EQ(told.size(), 1u) << "nobody is left to tell";
  Command release;
  std::vector<ZoneId> released;
  while (commands.pop(release)) released.push_back(release.lease.zone);
  settle();
  while (commands.pop(release)) released.push_back(release.lease.zone);
  std::ranges::sort(released);
  EXPECT_EQ(released, (std::vector<ZoneId>{0, 1}));
}

TEST_F(Desk, ReleasesWaitForRoomInTheQueue) {
  ASSERT_TRUE(router.post(1, 10, command_of(Command::Kind::kLease, 0), 0).ok());
  answer();
  settle();
  while (commands.push(Command())) {
  }
  router.client_gone(1);
  settle();
  Command command;
  while (commands.pop(command)) EXPECT_NE(command.kind, Command::Kind::kRelease);
  settle();
  ASSERT_TRUE(commands.pop(command));
  EXPECT_EQ(command.kind, Command::Kind::kRelease);
}

TEST_F(Desk, ForgetsLeasesAtTheirDeadline) {
  ASSERT_TRUE(router.post(1, 10, command_of(Command::Kind::kLease, 0), 0).ok());
  answer();
  settle(0, 1000);
  settle(0, 1000 + kLease_ns);
  EXPECT_EQ(router.leases(), 1u);
  settle(0, 1001 + kLease_ns);
  EXPECT_EQ(router.leases(), 0u);
  EXPECT_EQ(zones[0].leases, 0u);
}

TEST_F(Desk, AClientReleasesOnlyItsOwn) {
  ASSERT_TRUE(router.post(1, 10, command_of(Command::Kind::kLease, 0), 0).ok());
  answer();
  settle();
  Command release = command_of(Command::Kind::kRelease);
  release.lease = {.zone = 0, .generation = 9, .epoch = 1};
  EXPECT_EQ(router.post(2, 20, release, 0).error().code, ErrorCode::kNotFound);
  EXPECT_TRUE(router.post(1, 11, release, 0).ok());
  EXPECT_EQ(router.leases(), 0u);
}

TEST_F(Desk, SaysWhichMapsZonesACommandIsOnAndHeedsNoReplyOfAnother) {
  router.use(zones, 4);
  ASSERT_TRUE(router.post(1, 10, command_of(Command::Kind::kLease), 0).ok());
  Command asked;
  ASSERT_TRUE(commands.pop(asked));
  EXPECT_EQ(asked.map, 4u);
  router.map_changed();
  router.use(zones, 5);
  CommandReply late;
  late.id = asked.id;
  late.map = 4;
  late.lease = {.zone = 0, .generation = 9, .epoch = 1};
  replies.push(late);
  settle();
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].reply.error.code, ErrorCode::kBusy);
  EXPECT_EQ(commands.size(), 0u) << "a release would be of another map's zone";
}

}  // namespace
}  // namespace zonepack
