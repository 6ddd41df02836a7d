// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "runtime/protocol/connection.hpp"
#include "runtime/serve/server.hpp"
#include "tests/support/rooms.hpp"
#include "tests/support/temporary_folder.hpp"

// A server with a run that tests script: the three rooms a, b, c of rooms.hpp, and a control side
// driven by the test.
namespace zonepack::testing_support {

inline Catalog three_room_catalog() {
  Catalog catalog;
  catalog.folder = "/nowhere";
  for (const char* name : {"a", "b", "c"}) {
    CatalogZone& zone = catalog.zones.emplace_back();
    zone.name = name;
    zone.zone_type = "room";
    zone.signatures = 10;
    zone.slots = 2;
  }
  return catalog;
}

struct FakeRun {
  test_support::TemporaryFolder folder;
  Catalog catalog = three_room_catalog();
  ZoneGraph graph = three_rooms();
  Seqlock<LiveStatus> status;
  SpscQueue<Event> events{16 * 1024};
  SpscQueue<Command> commands{64};
  SpscQueue<CommandReply> replies{512};
  SpscQueue<PoseCorrection> poses{64};
  ServerPorts ports{status, events, commands, replies, poses};
  ServeSettings settings;
  std::unique_ptr<Server> server;
  std::uint32_t map = 1;  // that events belong to

  FakeRun() {
    settings.socket = folder / "s";
    ports.lease_ns = 1'000'000'000;
  }

  bool open() {
    auto opened = Server::open(settings, ports, catalog, graph, {});
    if (!opened) {
      std::fprintf(stderr, "%s\n", opened.error().message.c_str());
      return false;
    }
    server = std::move(*opened);
    return true;
  }

  void happen(EventKind kind, ZoneId zone, std::uint32_t generation = 1) {
    Event event;
    event.kind = kind;
    event.map = map;
    event.zone = zone;
    event.generation = generation;
    events.push(event);
  }
  void load(ZoneId zone, std::uint32_t generation = 1) {
    happen(EventKind::kLoadStarted, zone, generation);
    happen(EventKind::kLoadDone, zone, generation);
  }
};

// Something that repeats in a thread until the end of the scope.
class Meanwhile {
 public:
  template <typename Step>
  explicit Meanwhile(Step step)
      : thread_([this, step] {
          while (!stop_.load()) step();
        }) {}
  ~Meanwhile() {
    stop_.store(true);
    thread_.join();
  }

 private:
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

// The server's thread.
class Serving {
 public:
  explicit Serving(FakeRun& run) : run_(run), thread_([&run] { run.server->run(); }) {}
  ~Serving() {
    run_.server->stop();
    thread_.join();
  }

 private:
  FakeRun& run_;
  std::thread thread_;
};

// Sends one request and waits for its reply before the next.
class Client {
 public:
  explicit Client(const std::string& path) : connection_(Connection::open(path, "test", 10'000)) {}

  bool connected() const { return connection_.ok(); }
  Error error() const { return connection_.error(); }
  Connection& connection() { return *connection_; }

  // make(builder) creates the body.
  template <typename Make>
  const wire::Reply& ask(Make make, std::span<const int> descriptors = {},
                         std::uint32_t map_serial = 0) {
    MessageBuilder message;
    const auto body = make(message.builder());
    const auto reply = connection_->ask(message, body, descriptors, map_serial);
    if (!reply) {
      std::fprintf(stderr, "no reply: %s\n", to_string(reply.error().code));
      std::abort();
    }
    return **reply;
  }
  const wire::Reply& pin(const char* zone) {
    return ask([&](auto& b) { return wire::CreatePin(b, kNoZone, b.CreateString(zone)); });
  }
  const wire::Reply& lease(ZoneId zone) {
    return ask([&](auto& b) { return wire::CreateTakeLease(b, zone); });
  }
  const wire::Status& status() {  // valid until the next request
    return *ask([](auto& b) { return wire::CreateAskStatus(b); }).body_as_Status();
  }

 private:
  Result<Connection> connection_;
};

// A request of each kind in turn.
inline std::span<const std::byte> some_request(MessageBuilder& message, int kind) {
  auto& b = message.builder();
  const auto id = static_cast<std::uint64_t>(kind) + 10;
  const wire::Pose pose(1, 2, 0);
  const wire::Covariance covariance(1, 0, 0, 1, 0, 1);
  const wire::Lease lease(0, 1, 1);
  switch (kind % 14) {
    case 0:
      return message.request(id, wire::CreateAskStatus(b));
    case 1:
      return message.request(id, wire::CreateAskZones(b, 1));
    case 2:
      return message.request(id, wire::CreateAskZone(b, kNoZone, b.CreateString("b")));
    case 3:
      return message.request(id, wire::CreateAskChanges(b, 1));
    case 4:
      return message.request(id, wire::CreateSubscribe(b, true, 10));
    case 5:
      return message.request(id, wire::CreateAskSignatures(b, 1));
    case 6:
      return message.request(id, wire::CreateAskNearest(b, 1, 2, 10, 5));
    case 7:
      return message.request(id, wire::CreateGivePose(b, wire::Clock::Run, 1, &pose, &covariance));
    case 8:
      return message.request(id, wire::CreateAskRoute(b, 0, 0, 2, 0, true));
    case 9: {
      const std::uint32_t zones[] = {0, 1, 2};
      return message.request(id, wire::CreateRouteHint(b, b.CreateVector(zones, 3)));
    }
    case 10:
      return message.request(id, wire::CreatePin(b, 0));
    case 11:
      return message.request(id, wire::CreateTakeLease(b, 2));
    case 12:
      return message.request(id, wire::CreateRelease(b, &lease));
    default:
      return message.request(id, wire::CreateDump(b));
  }
}

inline std::size_t open_descriptors() {
  return static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {}));
}

// True as soon as `holds` is; false when it never is. The limit is long, for hosts that stall.
inline bool soon(const std::function<bool()>& holds) {
  for (int i = 0; i < 5000; ++i) {
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return false;
}

}  // namespace zonepack::testing_support
