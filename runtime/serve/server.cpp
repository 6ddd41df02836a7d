// SPDX-License-Identifier: Apache-2.0
#include "runtime/serve/server.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "platform/memory/account.hpp"
#include "platform/process/clock.hpp"

namespace zonepack {
namespace {

constexpr std::uint32_t kFirstSession = 16;  // tokens of the poller; listeners have lower ones
constexpr std::size_t kMostEventsAtOnce = 256;
constexpr std::int64_t kAcceptPause_ns = 100'000'000;

std::string listen_reason(const Error& error) {
  switch (error.code) {
    case ErrorCode::kExists:
      return "another zoned listens there, or it is a file of another kind; stop the other,"
             " or give this one its own serve.socket";
    case ErrorCode::kTooLarge:
      return "the path is over " + std::to_string(LocalListener::kMostPath) + " bytes";
    default:
      return std::string("cannot be made: ") + std::strerror(static_cast<int>(error.detail)) +
             "; the folder must exist and be writable for this user (serve.socket, --socket)";
  }
}

Failure cannot_listen(const std::string& path, const Error& error) {
  return failure("socket " + path + ": " + listen_reason(error), error.code);
}

std::unique_ptr<ServedMap> served_map(const Catalog& catalog, const ZoneGraph& graph,
                                      std::uint32_t serial, std::uint32_t epoch,
                                      std::span<const ZoneId> pinned) {
  auto map = std::make_unique<ServedMap>(ServedMap{catalog, graph, serial, epoch,
                                                   ZoneTable(catalog.zones.size(), pinned),
                                                   ZoneActivity(), std::nullopt});
  if (Result<NodeStore> nodes = NodeStore::open(catalog); nodes) {
    map->nodes.emplace(std::move(nodes).value());
  }
  return map;
}

std::uint64_t lost_events(const LiveStatus& status) noexcept {
  return status.overload.lost_service_events;
}

}  // namespace

Server::Server(const ServeSettings& settings, const ServerPorts& ports, Poller poller)
    : settings_(settings),
      ports_(ports),
      poller_(std::move(poller)),
      sessions_(settings.clients),
      handler_(ports_, settings.requests_per_s, counters_),
      buffer_(kMostMessageBytes / sizeof(std::uint64_t)),
      started_ns_(monotonic_ns()) {
  events_.reserve(kMostEventsAtOnce);
}

Server::~Server() = default;

Outcome<std::unique_ptr<Server>> Server::open(const ServeSettings& settings,
                                              const ServerPorts& ports, const Catalog& catalog,
                                              const ZoneGraph& graph,
                                              std::span<const ZoneId> pinned) {
  Result<Poller> poller = Poller::create();
  if (!poller) {
    return failure("sockets cannot be waited for: " + reason_text(poller.error()),
                   poller.error().code);
  }
  std::unique_ptr<Server> server(new Server(settings, ports, std::move(poller).value()));
  server->map_ = served_map(catalog, graph, 1, ports.map_epoch, pinned);
  server->handler_.router().use(server->map_->zones, server->map_->serial);
  auto listening = server->add_listener(settings.socket, settings.mode, false);
  if (listening) {
    listening = server->add_listener(settings.looking_socket, settings.looking_mode, true);
  }
  if (!listening) return listening.error();
  return server;
}

Outcome<void> Server::add_listener(const std::string& path, const std::string& mode,
                                   bool looking_only) {
  if (path.empty()) return {};
  std::optional<std::uint32_t> group;
  if (!settings_.group.empty()) {
    const auto number = group_number(settings_.group);
    if (!number) {
      const bool none = number.error().code == ErrorCode::kNotFound;
      return failure("socket " + path + ": group \"" + settings_.group + "\": " +
                         (none ? "there is no such group; groupadd --system " + settings_.group +
                                     ", or name one of /etc/group (serve.group)"
                               : reason_text(number.error())),
                     number.error().code);
    }
    group = *number;
  }
  const std::optional<unsigned> bits = socket_mode(mode);
  if (!bits) {
    return failure("socket " + path + ": mode \"" + mode +
                   "\" is none; expected octal digits such as 0660");
  }
  Result<LocalListener> listener = LocalListener::listen(path, *bits, group);
  if (!listener && group && listener.error().detail == EPERM) {
    return failure("socket " + path + ": cannot be given to group \"" + settings_.group +
                       "\" (serve.group): zoned's user is not in it; in the unit: "
                       "SupplementaryGroups=" +
                       settings_.group,
                   listener.error().code);
  }
  if (!listener) return cannot_listen(path, listener.error());
  listeners_.push_back({std::move(listener).value(), looking_only});
  const auto token = static_cast<std::uint32_t>(listeners_.size() - 1);
  const auto added = poller_.add(listeners_.back().socket.fd(), token, Poller::kReadable);
  if (!added) return cannot_listen(path, added.error());
  return {};
}

void Server::offer_map(std::uint32_t serial, const Catalog& catalog, const ZoneGraph& graph,
                       std::span<const ZoneId> pinned) {
  offered_ = served_map(catalog, graph, serial, map_->epoch == 0 ? 0 : map_->epoch + 1, pinned);
}

void Server::forget_map(std::uint32_t serial) {
  if (map_->serial == serial) change_map();
  if (offered_ && offered_->serial == serial) offered_.reset();
}

void Server::change_map() {
  if (!offered_) return;
  handler_.router().map_changed();
  map_ = std::move(offered_);
  handler_.router().use(map_->zones, map_->serial);
  ++counters_.map_changes;
  MessageBuilder message;
  const auto notice = message.reply(
      0, wire::CreateMapChanged(message.builder(), map_->serial,
                                static_cast<std::uint32_t>(map_->catalog.zones.size())));
  for (auto& session : sessions_) {
    if (session && session->greeted) session->answer(notice);
  }
}

bool Server::post(const Command& command) {
  return handler_.router().post(0, 0, command, monotonic_ns()).ok();
}

void Server::run() {
  while (!stop_.load(std::memory_order_relaxed)) {
    turn(handler_.busy() ? kTurnWhenAsked_ms : kTurn_ms);
  }
}

void Server::stop() noexcept {
  stop_.store(true, std::memory_order_relaxed);
  poller_.wake();
}

void Server::turn(int timeout_ms) {
  std::array<Poller::Ready, 64> space;
  const std::span<const Poller::Ready> ready = poller_.wait(space, timeout_ms);
  now_ns_ = monotonic_ns();
  counters_.uptime_ns = now_ns_ - started_ns_;
  take_events();
  settle();
  for (auto& session : sessions_) {
    if (!session) continue;
    counters_.throttled += session->begins_to_wait() ? 1 : 0;
    session->refill(now_ns_);
  }
  for (const Poller::Ready& one : ready) {
    if (one.token < kFirstSession) {
      accept(one.token);
      continue;
    }
    Session* const session = sessions_[one.token - kFirstSession].get();
    if (session == nullptr) continue;
    if (one.writable) session->flush(now_ns_);
    if (one.readable || one.closed) receive(*session);
    if (one.closed) session->drop();
  }
  send_poses();
  tidy();
}

void Server::take_events() {
  const std::uint64_t lost = lost_events(ports_.status.load());
  events_.clear();
  for (Event event; ports_.events.pop(event);) {
    const bool changed = event.kind == EventKind::kMapChanged;
    if (event.map != map_->serial && !changed) {
      notify_subscribers();
      if (offered_ && offered_->serial == event.map) change_map();  // map_changed was lost
      if (event.map != map_->serial) continue;
    }
    map_->zones.take(event);
    map_->activity.take(event);
    counters_.not_keeping_up += event.kind == EventKind::kNotKeepingUp ? 1 : 0;
    events_.push_back(event);
    if (event.kind == EventKind::kMapRefused) {
      offered_.reset();
      ++counters_.map_refusals;
    }
    if (!changed && events_.size() < kMostEventsAtOnce) continue;
    notify_subscribers();
    if (changed) change_map();
  }
  notify_subscribers();
  if (lost == lost_events_) return;
  if (ports_.resident_generation) map_->zones.resync(ports_.resident_generation);
  for (auto& session : sessions_) {
    if (session && session->wants_events) session->lose_events(lost - lost_events_);
  }
  lost_events_ = lost;
}

// Sends the events gathered so far, which belong to the map in use.
void Server::notify_subscribers() {
  const bool anyone = std::ranges::any_of(
      sessions_, [](const auto& session) { return session && session->wants_events; });
  for (std::span<const Event> rest = events_; anyone && !rest.empty();) {
    MessageBuilder message;
    const std::size_t before = rest.size();
    const Message notice = events_notice(message, *map_, rest);
    for (auto& session : sessions_) {
      if (!session || !session->wants_events) continue;
      const std::uint64_t lost_before = session->lost_events();
      session->offer_events(notice, before - rest.size());
      counters_.events_undelivered += session->lost_events() - lost_before;
    }
  }
  events_.clear();
}

void Server::settle() {
  handler_.router().settle(now_ns_, ports_.status.load().now_ns, ports_.lease_ns,
                           [this](const CommandRouter::Settled& settled) {
                             if (Session* const session = session_of(settled.client)) {
                               handler_.deliver(*session, settled);
                             }
                           });
  if (const auto dump = handler_.poll_dump(now_ns_)) {
    if (Session* const session = session_of(dump->client)) RequestHandler::deliver(*session, *dump);
  }
  counters_.leases = static_cast<std::uint32_t>(handler_.router().leases());
}

Session* Server::session_of(std::uint64_t key) noexcept {
  const auto found = std::ranges::find_if(
      sessions_, [key](const auto& session) { return session && session->key == key; });
  return found == sessions_.end() ? nullptr : found->get();
}

void Server::accept(std::size_t listener) {
  for (std::size_t i = 0; i < kMostAccepts; ++i) {
    Result<LocalSocket> socket = listeners_[listener].socket.accept();
    if (!socket) {
      // Out of descriptors, for example: waiting clients keep waiting, and this thread does not
      // spin.
      if (socket.error().code != ErrorCode::kBusy) pause_or_resume(listeners_[listener], listener);
      return;
    }
    const auto place =
        std::ranges::find_if(sessions_, [](const auto& session) { return !session; });
    if (place == sessions_.end()) {
      ++counters_.clients_refused;
      MessageBuilder message;
      // If there is no room even for this, closing says it too.
      [[maybe_unused]] const auto sent =
          socket->send(message.fault(0, wire::Fault::TooMany, "too many clients (serve.clients)"));
      continue;
    }
    auto session = std::make_unique<Session>(std::move(socket).value(), ++last_key_,
                                             listeners_[listener].looking_only,
                                             settings_.requests_per_s, now_ns_);
    const auto token = static_cast<std::uint32_t>(place - sessions_.begin()) + kFirstSession;
    if (!poller_.add(session->socket.fd(), token, session->registered)) continue;
    *place = std::move(session);
    ++counters_.clients;
  }
}

void Server::pause_or_resume(Listener& listener, std::size_t token) {
  const auto interest = listener.paused_until_ns == 0 ? Poller::kNothing : Poller::kReadable;
  listener.paused_until_ns = listener.paused_until_ns == 0 ? now_ns_ + kAcceptPause_ns : 0;
  [[maybe_unused]] const auto changed =
      poller_.change(listener.socket.fd(), static_cast<std::uint32_t>(token), interest);
}

void Server::receive(Session& session) {
  const std::span<std::byte> buffer = std::as_writable_bytes(std::span(buffer_));
  for (std::size_t i = 0; i < kMostRequests && session.may_ask(); ++i) {
    Result<LocalSocket::Received> received = session.socket.receive(buffer);
    if (!received && received.error().code == ErrorCode::kBusy) return;
    if (!received || received->bytes == 0) return session.drop();
    session.pay();
    handler_.take(session, *received, buffer.first(received->bytes), *map_, now_ns_);
  }
}

void Server::send_poses() {
  const auto wants = [this](const auto& session) {
    return session && session->pose_period_ns > 0 && session->next_pose_ns <= now_ns_;
  };
  if (std::ranges::none_of(sessions_, wants)) return;
  MessageBuilder message;
  const Message notice = answer_pose(message, 0, ports_.status.load());
  for (auto& session : sessions_) {
    if (!wants(session)) continue;
    session->offer(notice);
    session->next_pose_ns = std::max(session->next_pose_ns + session->pose_period_ns,
                                     now_ns_ - std::int64_t{kTurn_ms} * 1'000'000);
  }
}

void Server::tidy() {
  for (std::size_t i = 0; i < listeners_.size(); ++i) {
    Listener& listener = listeners_[i];
    if (listener.paused_until_ns != 0 && listener.paused_until_ns <= now_ns_)
      pause_or_resume(listener, i);
  }
  for (std::size_t i = 0; i < sessions_.size(); ++i) {
    std::unique_ptr<Session>& session = sessions_[i];
    if (!session) continue;
    session->check(now_ns_);
    if (session->dropped()) {
      counters_.clients_dropped += session->was_late() ? 1 : 0;
      handler_.client_gone(session->key);
      session.reset();
      --counters_.clients;
      continue;
    }
    const Poller::Interest interest = session->interest();
    if (interest == session->registered) continue;
    const auto token = static_cast<std::uint32_t>(i) + kFirstSession;
    if (poller_.change(session->socket.fd(), token, interest)) session->registered = interest;
  }
}

}  // namespace zonepack
