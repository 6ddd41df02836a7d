// SPDX-License-Identifier: Apache-2.0
#include "runtime/serve/command_router.hpp"

#include <algorithm>

namespace zonepack {
namespace {

bool same(const Lease& a, const Lease& b) noexcept {
  return a.zone == b.zone && a.generation == b.generation && a.epoch == b.epoch;
}

}  // namespace

CommandRouter::CommandRouter(SpscQueue<Command>& commands, SpscQueue<CommandReply>& replies)
    : commands_(commands), replies_(replies) {
  pending_.reserve(kMostPending);
  held_.reserve(kMostLeases);
  to_release_.reserve(kMostLeases);
}

bool CommandRouter::hand_over(Command& command) noexcept {
  command.id = last_id_ + 1;
  command.map = map_;
  if (!commands_.push(command)) return false;
  ++last_id_;
  return true;
}

Result<void> CommandRouter::post(ClientKey client, std::uint64_t request_id, Command command,
                                 std::int64_t monotonic_ns) {
  if (pending_.size() == kMostPending) return ErrorCode::kBusy;
  auto held = held_.end();
  if (command.kind == Command::Kind::kRelease) {
    held = std::ranges::find_if(held_, [&](const Held& entry) {
      return entry.client == client && same(entry.lease, command.lease);
    });
    if (held == held_.end()) return ErrorCode::kNotFound;
  }
  if (command.kind == Command::Kind::kLease) {
    const auto asked = std::ranges::count_if(
        pending_, [](const Pending& entry) { return entry.settled.kind == Command::Kind::kLease; });
    if (held_.size() + to_release_.size() + static_cast<std::size_t>(asked) >= kMostLeases) {
      return ErrorCode::kTooLarge;
    }
  }
  if (!hand_over(command)) return ErrorCode::kBusy;
  if (held != held_.end()) drop_lease(static_cast<std::size_t>(held - held_.begin()));
  Pending& pending = pending_.emplace_back();
  pending.settled = {client, request_id, command.kind, {}};
  pending.zone = command.zone;
  pending.command_id = command.id;
  pending.give_up_ns = monotonic_ns + kPatience_ns;
  return {};
}

void CommandRouter::settle(std::int64_t monotonic_ns, std::int64_t run_ns, std::int64_t lease_ns,
                           const std::function<void(const Settled&)>& deliver) {
  CommandReply reply;
  while (replies_.pop(reply)) {
    if (reply.map != 0 && reply.map != map_) continue;  // of a map that is gone, like its leases
    const auto found = std::ranges::find(pending_, reply.id, &Pending::command_id);
    if (found == pending_.end()) {
      if (reply.lease.zone != kNoZone) release_later(reply.lease);  // given up before it came
      continue;
    }
    const Pending pending = *found;
    pending_.erase(found);
    note(pending, reply, run_ns + lease_ns);
    Settled settled = pending.settled;
    settled.reply = reply;
    if (settled.client != 0) deliver(settled);
  }
  for (std::size_t i = pending_.size(); i-- > 0;) {
    if (pending_[i].give_up_ns > monotonic_ns) continue;
    Settled settled = pending_[i].settled;
    settled.reply.error = {ErrorCode::kBusy, 0};
    pending_.erase(pending_.begin() + static_cast<std::ptrdiff_t>(i));
    if (settled.client != 0) deliver(settled);
  }
  for (std::size_t i = held_.size(); i-- > 0;) {
    if (held_[i].ends_ns < run_ns) drop_lease(i);
  }
  while (!to_release_.empty()) {
    Command command;
    command.kind = Command::Kind::kRelease;
    command.lease = to_release_.back();
    if (!hand_over(command)) break;
    to_release_.pop_back();
  }
}

void CommandRouter::note(const Pending& pending, const CommandReply& reply, std::int64_t ends_ns) {
  if (reply.error.code != ErrorCode::kOk) return;
  switch (pending.settled.kind) {
    case Command::Kind::kPin:
    case Command::Kind::kUnpin:
      zones_->set_pinned(pending.zone, pending.settled.kind == Command::Kind::kPin);
      return;
    case Command::Kind::kLease:
      if (pending.settled.client == 0) return release_later(reply.lease);
      held_.push_back({pending.settled.client, reply.lease, ends_ns});
      zones_->add_leases(reply.lease.zone, 1);
      return;
    default:
      return;
  }
}

void CommandRouter::client_gone(ClientKey client) {
  for (Pending& pending : pending_) {
    if (pending.settled.client == client) pending.settled.client = 0;
  }
  for (std::size_t i = held_.size(); i-- > 0;) {
    if (held_[i].client != client) continue;
    release_later(held_[i].lease);
    drop_lease(i);
  }
}

void CommandRouter::map_changed() {
  held_.clear();
  to_release_.clear();
  for (Pending& pending : pending_) pending.command_id = 0;
  for (Pending& pending : pending_) pending.give_up_ns = 0;
}

void CommandRouter::drop_lease(std::size_t index) {
  zones_->add_leases(held_[index].lease.zone, -1);
  held_.erase(held_.begin() + static_cast<std::ptrdiff_t>(index));
}

// One for which there is no room ends by itself at its deadline.
void CommandRouter::release_later(const Lease& lease) {
  if (to_release_.size() < kMostLeases) to_release_.push_back(lease);
}

}  // namespace zonepack
