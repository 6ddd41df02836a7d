// SPDX-License-Identifier: Apache-2.0
#include "runtime/serve/request_handler.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <memory>
#include <utility>

#include "platform/base/failure.hpp"
#include "platform/files/bounded_writer.hpp"
#include "platform/process/clock.hpp"
#include "runtime/serve/external_pose.hpp"

namespace zonepack {

using wire::RequestBody;

namespace {

constexpr BoundedWriter::Terms kDumpTerms{};
constexpr std::int64_t kDumpOverdue_ns =
    std::chrono::nanoseconds(kDumpTerms.in_all + kDumpTerms.idle).count();

}  // namespace

RequestHandler::RequestHandler(const ServerPorts& ports, std::uint32_t requests_per_s,
                               ServerCounters& counters)
    : ports_(ports),
      requests_per_s_(requests_per_s),
      counters_(counters),
      router_(ports.commands, ports.replies) {}

void RequestHandler::refuse(const Call& call, wire::Fault fault, std::string_view text) {
  MessageBuilder message;
  call.from.answer(message.fault(call.id(), fault, text));
}

void RequestHandler::take(Session& from, LocalSocket::Received& received, Message bytes,
                          ServedMap& map, std::int64_t monotonic_ns) {
  ++counters_.requests;
  const auto request = check_request(bytes);
  if (received.cut || !request || (*request)->id() == 0) {
    ++counters_.malformed;
    MessageBuilder message;
    from.answer(message.fault(request ? (*request)->id() : 0, wire::Fault::Malformed));
    // A client that has not said hello does not speak this protocol.
    if (!from.greeted) from.drop();
    return;
  }
  const Call call{from, **request, received, map, monotonic_ns};
  if (call.request.body_type() == RequestBody::Hello) return greet(call);
  if (!from.greeted) return refuse(call, wire::Fault::Hello);
  if (call.request.map_serial() != 0 && call.request.map_serial() != map.serial) {
    return refuse(call, wire::Fault::StaleMap);
  }
  handle(call);
}

void RequestHandler::greet(const Call& call) {
  // The welcome carries descriptors, of which a user may have only so many on their way at once:
  // one that repeats its hello without reading would use them up for all.
  if (call.from.greeted) return refuse(call, wire::Fault::Malformed, "hello comes once");
  if (call.request.body_as_Hello()->version() != kProtocolVersion) {
    refuse(call, wire::Fault::Version,
           "this zoned speaks version " + std::to_string(kProtocolVersion));
    return;
  }
  MessageBuilder message;
  flatbuffers::FlatBufferBuilder& builder = message.builder();
  std::vector<std::uint8_t> kinds;
  std::vector<int> descriptors;
  const auto offer = [&](wire::FdKind kind, int fd) {
    if (fd < 0) return;
    kinds.push_back(static_cast<std::uint8_t>(kind));
    descriptors.push_back(fd);
  };
  offer(wire::FdKind::Memory, ports_.memory_fd);
  offer(wire::FdKind::Lock, ports_.presence_fd);
  const Catalog& catalog = call.map.catalog;
  std::uint64_t signatures = 0;
  for (const CatalogZone& zone : catalog.zones) signatures += zone.signatures;
  const auto program = builder.CreateString("zoned");
  const auto release = builder.CreateString(ports_.release);
  const auto commit = builder.CreateString(ports_.commit);
  const auto detector = builder.CreateString(catalog.detector);
  const auto lineage = builder.CreateVector(catalog.lineage.data(), catalog.lineage.size());
  const auto version = builder.CreateVector(catalog.version.data(), catalog.version.size());
  const auto kind_list =
      builder.CreateVector(reinterpret_cast<const wire::FdKind*>(kinds.data()), kinds.size());
  const auto welcome =
      wire::CreateWelcome(builder, kProtocolVersion, program, lineage, version, call.map.serial,
                          static_cast<std::uint32_t>(catalog.zones.size()), signatures, kind_list,
                          call.from.looking_only, kMostMessageBytes, requests_per_s_,
                          ports_.lease_ns, call.map.epoch, release, commit, detector);
  call.from.greeted = true;
  call.from.answer(message.reply(call.id(), welcome), descriptors);
}

void RequestHandler::handle(const Call& call) {
  if (look(call)) return;
  if (call.from.looking_only) return refuse(call, wire::Fault::Denied);
  const wire::Request& request = call.request;
  switch (request.body_type()) {
    case RequestBody::GivePose:
      return take_pose(call);
    case RequestBody::RouteHint:
      return hint(call);
    case RequestBody::Pin:
      return command_on_zone(call, Command::Kind::kPin, request.body_as_Pin()->zone(),
                             request.body_as_Pin()->name());
    case RequestBody::Unpin:
      return command_on_zone(call, Command::Kind::kUnpin, request.body_as_Unpin()->zone(),
                             request.body_as_Unpin()->name());
    case RequestBody::Freeze:
    case RequestBody::Unfreeze: {
      Command order;
      order.kind = request.body_type() == RequestBody::Freeze ? Command::Kind::kFreeze
                                                              : Command::Kind::kUnfreeze;
      return command(call, order);
    }
    case RequestBody::TakeLease:
      return command_on_zone(call, Command::Kind::kLease, request.body_as_TakeLease()->zone(),
                             request.body_as_TakeLease()->name());
    case RequestBody::Release: {
      const wire::Lease& lease = *request.body_as_Release()->lease();
      Command order;
      order.kind = Command::Kind::kRelease;
      order.lease = {lease.zone(), lease.generation(), lease.epoch()};
      return command(call, order);
    }
    case RequestBody::Dump:
      return start_dump(call);
    case RequestBody::ReportLocalizer:
      return take_report(call);
    case RequestBody::LosePose:
    case RequestBody::AskTurn: {
      Command order;
      order.kind = request.body_type() == RequestBody::LosePose ? Command::Kind::kLost
                                                                : Command::Kind::kAskTurn;
      return command(call, order);
    }
    case RequestBody::SeekZone:
      return command_on_zone(call, Command::Kind::kSeek, request.body_as_SeekZone()->zone(),
                             request.body_as_SeekZone()->name());
    default:
      ++counters_.malformed;
      return refuse(call, wire::Fault::Malformed, "unknown request");
  }
}

// Handles what any client may ask; false for other requests.
bool RequestHandler::look(const Call& call) {
  const wire::Request& request = call.request;
  MessageBuilder message;
  switch (request.body_type()) {
    case RequestBody::AskStatus:
      call.from.answer(answer_status(message, call.id(), call.map, ports_.status.load(), counters_,
                                     ports_.lines, &localizers_));
      return true;
    case RequestBody::AskZones:
      call.from.answer(answer_zones(message, call.id(), call.map,
                                    request.body_as_AskZones()->first(),
                                    request.body_as_AskZones()->active_only()));
      return true;
    case RequestBody::AskOutlines:
      call.from.answer(
          answer_outlines(message, call.id(), call.map, request.body_as_AskOutlines()->first()));
      return true;
    case RequestBody::AskZone: {
      const wire::AskZone& ask = *request.body_as_AskZone();
      const ZoneId zone = call.map.find(ask.zone(), ask.name());
      call.from.answer(zone == kNoZone ? no_such_zone(message, call.id(), ask.zone(), ask.name())
                                       : answer_zone(message, call.id(), call.map, zone));
      return true;
    }
    case RequestBody::AskChanges:
      call.from.answer(
          answer_changes(message, call.id(), call.map, request.body_as_AskChanges()->since()));
      return true;
    case RequestBody::AskPose:
      call.from.answer(answer_pose(message, call.id(), ports_.status.load()));
      return true;
    case RequestBody::AskNearest:
      call.from.answer(answer_nearest(message, call.id(), call.map, *request.body_as_AskNearest()));
      return true;
    case RequestBody::AskSignatures:
      send_signatures(call);
      return true;
    case RequestBody::Subscribe:
      subscribe(call);
      return true;
    case RequestBody::AskRoute:
      plan(call);
      return true;
    default:
      return false;
  }
}

void RequestHandler::send_signatures(const Call& call) {
  const wire::AskSignatures& ask = *call.request.body_as_AskSignatures();
  const ZoneId zone = call.map.find(ask.zone(), ask.name());
  MessageBuilder message;
  call.from.answer(zone == kNoZone
                       ? no_such_zone(message, call.id(), ask.zone(), ask.name())
                       : answer_signatures(message, call.id(), call.map, zone, ask.first()));
}

void RequestHandler::subscribe(const Call& call) {
  const wire::Subscribe& ask = *call.request.body_as_Subscribe();
  if (!(ask.pose_hz() >= 0 && ask.pose_hz() <= kMostPoseHz)) {
    return refuse(call, wire::Fault::Malformed, "expected pose_hz 0 to 100");
  }
  call.from.wants_events = ask.events();
  // A rate may be any float above zero, whose period is not always a number of nanoseconds.
  const double period_ns =
      std::min(1e9 / static_cast<double>(ask.pose_hz()), kLongestPosePeriod_ns);
  call.from.pose_period_ns = ask.pose_hz() > 0 ? static_cast<std::int64_t>(period_ns) : 0;
  call.from.next_pose_ns = call.monotonic_ns;
  MessageBuilder message;
  call.from.answer(message.reply(call.id(), wire::CreateDone(message.builder())));
}

void RequestHandler::plan(const Call& call) {
  const wire::AskRoute& ask = *call.request.body_as_AskRoute();
  if (ask.hint() && call.from.looking_only) return refuse(call, wire::Fault::Denied);
  const LiveStatus status = ports_.status.load();
  // Without a zone to start from: the robot's own, from its position.
  const bool from_robot = ask.from() == kNoZone && ask.from_name() == nullptr;
  const ZoneId from = from_robot ? status.state.zone : call.map.find(ask.from(), ask.from_name());
  const ZoneId to = call.map.find(ask.to(), ask.to_name());
  MessageBuilder message;
  if (from_robot && from >= call.map.catalog.zones.size()) {
    return refuse(call, wire::Fault::NotFound, "the robot is in no zone; name one to start from");
  }
  if (from == kNoZone) {
    return call.from.answer(no_such_zone(message, call.id(), ask.from(), ask.from_name()));
  }
  if (to == kNoZone) {
    return call.from.answer(no_such_zone(message, call.id(), ask.to(), ask.to_name()));
  }
  std::optional<Point2> start;
  if (from_robot && status.state.pose.valid) {
    start = Point2{status.state.pose.T_map_base.x_m, status.state.pose.T_map_base.y_m};
  }
  const Result<Route> route = plan_route(call.map.graph, from, to, start);
  if (!route) {
    const bool none = route.error().code == ErrorCode::kNotFound;
    return refuse(call, none ? wire::Fault::NotFound : wire::Fault::TooMany,
                  none ? "no way leads there" : "too far for one plan; plan to a zone on the way");
  }
  if (ask.hint()) {
    Command order;
    order.kind = Command::Kind::kRouteHint;
    order.route_length =
        static_cast<std::uint32_t>(std::min(route->zones.size(), Command::kMostRoute));
    std::copy_n(route->zones.begin(), order.route_length, order.route.begin());
    // The answer is the route; the command's own reply goes to nobody.
    if (const auto posted = router_.post(0, 0, order, call.monotonic_ns); !posted) {
      return refuse(call, fault_of(posted.error()));
    }
  }
  call.from.answer(answer_route(message, call.id(), call.map, *route, ask.hint()));
}

void RequestHandler::command(const Call& call, Command command) {
  const auto posted = router_.post(call.from.key, call.id(), command, call.monotonic_ns);
  if (!posted) refuse(call, fault_of(posted.error()));
}

void RequestHandler::command_on_zone(const Call& call, Command::Kind kind, std::uint32_t zone,
                                     const flatbuffers::String* name) {
  Command order;
  order.kind = kind;
  order.zone = call.map.find(zone, name);
  if (order.zone == kNoZone) {
    MessageBuilder message;
    return call.from.answer(no_such_zone(message, call.id(), zone, name));
  }
  command(call, order);
}

void RequestHandler::hint(const Call& call) {
  static_assert(kMostRouteHint == Command::kMostRoute);
  const auto* const zones = call.request.body_as_RouteHint()->zones();
  Command order;
  order.kind = Command::Kind::kRouteHint;
  order.route_length = zones == nullptr ? 0 : zones->size();
  if (order.route_length > Command::kMostRoute) {
    return refuse(call, wire::Fault::Malformed, "expected at most 64 zones");
  }
  for (std::uint32_t i = 0; i < order.route_length; ++i) {
    order.route[i] = zones->Get(i);
    if (order.route[i] < call.map.catalog.zones.size()) continue;
    MessageBuilder message;
    return call.from.answer(no_such_zone(message, call.id(), order.route[i], nullptr));
  }
  command(call, order);
}

void RequestHandler::take_pose(const Call& call) {
  const LiveStatus status = ports_.status.load();
  const ClockReading now{call.monotonic_ns, status.run_ns(call.monotonic_ns),
                         status.clock_offset_ns};
  const auto correction = correction_of(*call.request.body_as_GivePose(), now);
  if (!correction) return refuse(call, wire::Fault::Malformed, "not a pose with a covariance");
  if (!ports_.poses.push(*correction)) return refuse(call, wire::Fault::Busy);
  MessageBuilder message;
  call.from.answer(message.reply(call.id(), wire::CreateDone(message.builder())));
}

void RequestHandler::take_report(const Call& call) {
  const auto taken =
      localizers_.take(call.from.key, *call.request.body_as_ReportLocalizer()->localizer());
  if (!taken && taken.error().code == ErrorCode::kBadValue) {
    return refuse(call, wire::Fault::Malformed, "a report over the limits of PROTOCOL.md");
  }
  if (!taken) return refuse(call, fault_of(taken.error()));
  MessageBuilder message;
  call.from.answer(message.reply(call.id(), wire::CreateDone(message.builder())));
}

void RequestHandler::start_dump(const Call& call) {
  if (!ports_.dump) return refuse(call, wire::Fault::Unavailable, "nothing is recorded");
  if (call.received.descriptor_count != 1) {
    return refuse(call, wire::Fault::Malformed, "expected one descriptor to write to");
  }
  if (dump_.running()) return refuse(call, wire::Fault::Busy, "another recording is being written");
  // Shared, because the job is copied on its way into the thread.
  auto file = std::make_shared<Descriptor>(std::move(call.received.descriptors[0]));
  dump_cancelled_.store(false);
  dump_began_ns_ = call.monotonic_ns;
  const auto started = dump_.start([this, file]() -> Result<std::uint64_t> {
    BoundedWriter to(file->get(), dump_cancelled_, kDumpTerms);
    return ports_.dump(to);
  });
  if (!started) return refuse(call, wire::Fault::Failed, "no thread could be started");
  dump_client_ = call.from.key;
  dump_request_ = call.id();
}

std::optional<RequestHandler::Dump> RequestHandler::poll_dump(std::int64_t monotonic_ns) {
  auto result = dump_.poll();
  if (result) return Dump{dump_client_, dump_request_, *result};
  // Only a client that undid O_NONBLOCK keeps the thread in a call for so long.
  if (dump_.running() && monotonic_ns - dump_began_ns_ > kDumpOverdue_ns) end_dump();
  return std::nullopt;
}

void RequestHandler::end_dump() noexcept {
  dump_cancelled_.store(true);
  dump_.interrupt();
}

bool RequestHandler::stop_dump(std::int64_t until_monotonic_ns) noexcept {
  constexpr std::int64_t kStep_ns = 10'000'000;
  while (dump_.running()) {
    end_dump();
    if (dump_.poll()) return true;
    const std::int64_t now_ns = monotonic_ns();
    if (now_ns >= until_monotonic_ns) return false;
    sleep_until_ns(now_ns + kStep_ns);
  }
  return true;
}

void RequestHandler::deliver(Session& to, const Dump& dump) {
  MessageBuilder message;
  if (!dump.bytes) {
    const Error& error = dump.bytes.error();
    const bool late = error.code == ErrorCode::kIo && error.detail == ETIMEDOUT;
    const std::string text = late ? "the descriptor did not take the recording in time: nothing "
                                    "for 10 s, or 120 s in all"
                                  : reason_text(error);
    return to.answer(message.fault(dump.request_id, wire::Fault::Failed, text));
  }
  to.answer(message.reply(dump.request_id, wire::CreateDumped(message.builder(), *dump.bytes)));
}

void RequestHandler::deliver(Session& to, const CommandRouter::Settled& settled) const {
  MessageBuilder message;
  const std::uint64_t id = settled.request_id;
  if (settled.reply.error.code != ErrorCode::kOk) {
    return to.answer(message.fault(id, fault_of(settled.reply.error)));
  }
  if (settled.kind == Command::Kind::kLease) {
    const Lease& granted = settled.reply.lease;
    const wire::Lease lease(granted.zone, granted.generation, granted.epoch);
    return to.answer(
        message.reply(id, wire::CreateGranted(message.builder(), &lease, ports_.lease_ns)));
  }
  to.answer(message.reply(id, wire::CreateDone(message.builder())));
}

}  // namespace zonepack
