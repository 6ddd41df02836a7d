// SPDX-License-Identifier: Apache-2.0
// Whatever clients do or fail to do, the control side keeps its steady rate, and each of its pushes
// finds room.
#include <gtest/gtest.h>

#include <random>

#include "tests/unit/runtime/serve/fake_run.hpp"

namespace zonepack {
namespace {

using testing_support::Client;
using testing_support::FakeRun;
using testing_support::Serving;
using testing_support::soon;
using wire::Fault;

// The control side: in each step it takes commands, replies, and publishes an event and its status,
// as the control thread does, and counts what found no room.
class Control {
 public:
  explicit Control(FakeRun& run) : run_(run), thread_([this] { go(); }) {}
  ~Control() { end(); }

  void end() {
    stop_.store(true);
    if (thread_.joinable()) thread_.join();
  }

  std::uint64_t steps() const { return steps_.load(); }
  std::uint64_t without_room() const { return without_room_.load(); }
  std::uint64_t poses() const { return poses_.load(); }

 private:
  void go() {
    while (!stop_.load()) {
      step();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  void step() {
    Command command;
    for (std::size_t i = 0; i < Cycle::kMostCommands && run_.commands.pop(command); ++i) {
      CommandReply reply;
      reply.id = command.id;
      if (command.kind == Command::Kind::kLease)
        reply.lease = {.zone = command.zone, .generation = 1, .epoch = 1};
      if (!run_.replies.push(reply)) ++without_room_;
    }
    PoseCorrection pose;
    if (run_.poses.pop(pose)) ++poses_;
    Event event;
    event.kind = steps_ % 2 == 0 ? EventKind::kZoneWanted : EventKind::kZoneUnwanted;
    event.zone = 0;
    if (!run_.events.push(event)) ++without_room_;
    LiveStatus status;
    status.now_ns = static_cast<std::int64_t>(++steps_) * 1'000'000;
    run_.status.store(status);
  }

  FakeRun& run_;
  std::atomic<bool> stop_{false};
  std::atomic<std::uint64_t> steps_{0}, without_room_{0}, poses_{0};
  std::thread thread_;
};

class Overload : public testing::Test {
 protected:
  FakeRun run;

  // The control side has kept stepping, with room for all its messages, and a new client is served.
  void expect_untouched(Control& control) {
    const std::uint64_t before = control.steps();
    EXPECT_TRUE(soon([&] { return control.steps() > before + 50; }));
    EXPECT_EQ(control.without_room(), 0u);
    ASSERT_TRUE(soon([&] { return Client(run.settings.socket).connected(); }));
    Client client(run.settings.socket);
    ASSERT_TRUE(client.connected());
    EXPECT_EQ(client.status().zones(), 3u);
  }
};

std::span<const std::byte> hello(MessageBuilder& message) {
  return message.request(1, wire::CreateHello(message.builder(), kProtocolVersion));
}

TEST_F(Overload, AFloodOfRequestsIsThrottledAndAllOfItAnswered) {
  run.settings.requests_per_s = 200;
  ASSERT_TRUE(run.open());
  Control control(run);
  const Serving serving(run);
  auto flood = LocalSocket::connect(run.settings.socket);
  ASSERT_TRUE(flood.ok());
  // 300 pins without waiting for replies: a quarter of a second's worth at once, then 200 a second.
  constexpr int kRequests = 300;
  int sent = 0, answered = 0;
  alignas(8) std::byte buffer[4096];
  MessageBuilder first;
  ASSERT_TRUE(flood->send(hello(first)).ok());
  ASSERT_TRUE(soon([&] {
    while (sent < kRequests) {
      MessageBuilder message;
      const auto pin = message.request(static_cast<std::uint64_t>(sent) + 2,
                                       wire::CreatePin(message.builder(), 1));
      if (!flood->send(pin)) break;
      ++sent;
    }
    while (flood->receive(buffer)) ++answered;
    return answered == kRequests + 1;
  }));
  Client watcher(run.settings.socket);
  EXPECT_GT(watcher.status().throttled_total(), 0u);
  expect_untouched(control);
}

TEST_F(Overload, AClientThatNeverReadsIsNotReadFromAndLosesItsEvents) {
  ASSERT_TRUE(run.open());
  Control control(run);
  const Serving serving(run);
  auto deaf = LocalSocket::connect(run.settings.socket);
  ASSERT_TRUE(deaf.ok());
  MessageBuilder first;
  ASSERT_TRUE(deaf->send(hello(first)).ok());
  MessageBuilder subscribe;
  ASSERT_TRUE(
      deaf->send(subscribe.request(2, wire::CreateSubscribe(subscribe.builder(), true, 100))).ok());
  // Asks for the map's zones again and again until no request is accepted: 32 KiB of answers in the
  // kernel, and one kept.
  std::uint64_t id = 3;
  ASSERT_TRUE(soon([&] {
    MessageBuilder message;
    return !deaf->send(message.request(id++, wire::CreateAskZones(message.builder())));
  }));
  Client watcher(run.settings.socket);
  ASSERT_TRUE(soon([&] { return watcher.status().events_undelivered_total() > 0; }));
  expect_untouched(control);
}

TEST_F(Overload, AThousandConnectsAreServedOrRefusedAndLeaveNothing) {
  run.settings.clients = 8;
  ASSERT_TRUE(run.open());
  Control control(run);
  const Serving serving(run);
  Client watcher(run.settings.socket);
  EXPECT_EQ(watcher.status().clients(), 1u);
  const std::size_t open_before = testing_support::open_descriptors();
  std::vector<LocalSocket> some;
  for (int i = 0; i < 1000; ++i) {
    auto socket = LocalSocket::connect(run.settings.socket);
    if (!socket) {
      ASSERT_EQ(socket.error().code, ErrorCode::kBusy) << i;  // the queue of listen() is full
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      continue;
    }
    some.push_back(std::move(*socket));
    if (some.size() > 16) some.erase(some.begin(), some.begin() + 8);
  }
  EXPECT_GT(watcher.status().clients_refused_total(), 0u);
  some.clear();
  expect_untouched(control);
  EXPECT_TRUE(soon([&] { return testing_support::open_descriptors() == open_before; }));
}

TEST_F(Overload, MoreClientsThanThereIsRoomForAreRefused) {
  run.settings.clients = 2;
  ASSERT_TRUE(run.open());
  const Serving serving(run);
  Client first(run.settings.socket);
  {
    Client second(run.settings.socket);
    ASSERT_TRUE(first.connected() && second.connected());
    Client third(run.settings.socket);
    EXPECT_FALSE(third.connected());
    EXPECT_EQ(third.error().code, ErrorCode::kBusy);
  }
  EXPECT_TRUE(soon([&] { return Client(run.settings.socket).connected(); }));
}

// Turns by hand: nothing depends on when threads run.
TEST_F(Overload, ASlowSubscriberLearnsHowManyEventsItLostAndIsDroppedInTheEnd) {
  ASSERT_TRUE(run.open());
  auto slow = LocalSocket::connect(run.settings.socket);
  MessageBuilder first, second;
  ASSERT_TRUE(slow->send(hello(first)).ok());
  ASSERT_TRUE(slow->send(second.request(2, wire::CreateSubscribe(second.builder(), true, 0))).ok());
  ASSERT_TRUE(soon([&] {
    run.server->turn(0);
    return run.server->counters().requests == 2;
  }));
  const auto tell = [&](int events) {
    for (int i = 0; i < events; ++i) run.happen(EventKind::kZoneWanted, 0);
    run.server->turn(0);
  };
  // Until the kernel takes no more, and a few that are lost.
  std::uint64_t told = 0;
  while (run.server->counters().events_undelivered == 0 && told < 10'000) {
    tell(10);
    told += 10;
  }
  const std::uint64_t lost = run.server->counters().events_undelivered;
  ASSERT_EQ(lost, 10u);
  std::uint64_t delivered = 0, said = 0;
  alignas(8) std::byte buffer[kMostMessageBytes];
  const auto read_all = [&] {
    for (auto got = slow->receive(buffer); got && got->bytes > 0; got = slow->receive(buffer)) {
      const wire::Reply& reply = **check_reply(std::span(buffer, got->bytes));
      if (const auto* events = reply.body_as_Events()) delivered += events->events()->size();
      if (const auto* words = reply.body_as_Lost()) said += words->events();
    }
  };
  read_all();
  tell(10);
  read_all();
  EXPECT_EQ(said, lost);
  EXPECT_EQ(delivered, told + 10 - lost);
  // And from here on never again.
  for (int i = 0; i < 1000 && run.server->counters().clients > 0; ++i) tell(10);
  EXPECT_EQ(run.server->counters().clients, 0u);
  EXPECT_EQ(run.server->counters().clients_dropped, 1u);
}

// Requests of all kinds, changed at random: the server answers what it can, and lives.
TEST_F(Overload, MadeUpMessagesDoNoHarm) {
  run.settings.requests_per_s = 1'000'000;
  ASSERT_TRUE(run.open());
  Control control(run);
  const Serving serving(run);
  std::mt19937 random(7);
  const auto changed = [&random](std::span<const std::byte> bytes, int i) {
    std::vector<std::byte> made_up(bytes.begin(), bytes.end());
    for (int n = 0; n < 1 + i % 3; ++n) {
      made_up[random() % made_up.size()] = static_cast<std::byte>(random());
    }
    if (i % 11 == 0) made_up.resize(1 + random() % made_up.size());
    if (i % 97 == 0) made_up.resize(kMostMessageBytes + 100);
    return made_up;
  };
  alignas(8) std::byte buffer[kMostMessageBytes];
  for (int round = 0; round < 60; ++round) {
    Client client(run.settings.socket);
    ASSERT_TRUE(client.connected());
    // Behind the client's back, on its own socket.
    const LocalSocket& socket = client.connection().socket();
    for (int i = round * 50; i < round * 50 + 50; ++i) {
      MessageBuilder message;
      const auto made_up = changed(testing_support::some_request(message, i), i);
      while (socket.send(made_up).error().code == ErrorCode::kBusy) {
        while (socket.receive(buffer)) {
        }
        std::this_thread::yield();
      }
    }
    // Still answered, after faults that belong to no request.
    EXPECT_TRUE(soon([&] {
      const auto ask = [](auto& b) { return wire::CreateAskStatus(b); };
      return client.ask(ask).body_as_Status() != nullptr;
    }));
  }
  Client watcher(run.settings.socket);
  EXPECT_GT(watcher.status().malformed_total(), 1000u);
  expect_untouched(control);
}

}  // namespace
}  // namespace zonepack
