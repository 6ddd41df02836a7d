// SPDX-License-Identifier: Apache-2.0
#include "runtime/recording/checkpoint.hpp"

#include <algorithm>

#include "platform/base/require.hpp"
#include "runtime/recording/block.hpp"

namespace zonepack {
namespace {

constexpr std::uint8_t kHasPose = 1, kFrozen = 2, kOtherMap = 4, kHeld = 8, kLost = 16,
                       kLearned = 32;
constexpr std::size_t kFixedRoom = 256;
constexpr std::size_t kZoneRoom = 10;  // two varints of 32 bits
constexpr std::size_t kMostZones = (kMostBlockBytes - kFixedRoom) / kZoneRoom / 2;
// More is left out: zones have the rest of the block.
constexpr std::size_t kMostLearned = kMostBlockBytes / 8;

void write_zones(const std::vector<ZoneId>& zones, ByteWriter& out) {
  const std::size_t count = std::min(zones.size(), kMostZones / 2);
  out.varint(count);
  for (std::size_t i = 0; i < count; ++i) out.varint(zones[i]);
}

bool read_zones(ByteReader& in, std::vector<ZoneId>& zones) {
  const std::uint64_t count = in.varint();
  if (count > in.left()) return false;
  for (std::uint64_t i = 0; i < count; ++i) zones.push_back(in.varint32());
  return in.ok();
}

}  // namespace

std::vector<std::byte> write_checkpoint(const Checkpoint& checkpoint) {
  const bool learned =
      !checkpoint.transitions.empty() && checkpoint.transitions.size() <= kMostLearned;
  std::vector<std::byte> bytes(kFixedRoom + (learned ? checkpoint.transitions.size() : 0) +
                               kZoneRoom * (checkpoint.resident.size() + checkpoint.pinned.size() +
                                            checkpoint.route.size()));
  ByteWriter out(bytes);
  out.u64(checkpoint.cycle);
  out.i64(checkpoint.now_ns);
  out.i64(checkpoint.start_ns);
  const bool other_map = checkpoint.map != 1 || checkpoint.offered_map != 0;
  out.u8(static_cast<std::uint8_t>((checkpoint.has_pose ? kHasPose : 0) |
                                   (checkpoint.frozen ? kFrozen : 0) | (other_map ? kOtherMap : 0) |
                                   (checkpoint.held ? kHeld : 0) | (checkpoint.lost ? kLost : 0) |
                                   (learned ? kLearned : 0)));
  out.f64(checkpoint.T_map_base.x_m);
  out.f64(checkpoint.T_map_base.y_m);
  out.f64(checkpoint.T_map_base.yaw_rad);
  out.f64(checkpoint.sigma_m);
  out.f64(checkpoint.sigma_rad);
  out.u32(checkpoint.zone);
  const std::size_t count = std::min(checkpoint.resident.size(), kMostZones);
  out.varint(count);
  for (std::size_t i = checkpoint.resident.size() - count; i < checkpoint.resident.size(); ++i) {
    out.varint(checkpoint.resident[i].zone);
    out.varint(checkpoint.resident[i].generation);
  }
  write_zones(checkpoint.pinned, out);
  write_zones(checkpoint.route, out);
  if (other_map) {
    out.u32(checkpoint.map);
    out.u32(checkpoint.offered_map);
  }
  if (checkpoint.lost) out.u32(checkpoint.sought);
  if (learned) {
    out.varint(checkpoint.transitions.size());
    out.bytes(checkpoint.transitions);
  }
  ZP_REQUIRE(out.ok());
  bytes.resize(out.size());
  return bytes;
}

Result<Checkpoint> read_checkpoint(ByteSpan content) {
  Checkpoint checkpoint;
  ByteReader in(content);
  checkpoint.cycle = in.u64();
  checkpoint.now_ns = in.i64();
  checkpoint.start_ns = in.i64();
  const std::uint8_t flags = in.u8();
  checkpoint.has_pose = (flags & kHasPose) != 0;
  checkpoint.frozen = (flags & kFrozen) != 0;
  checkpoint.held = (flags & kHeld) != 0;
  checkpoint.lost = (flags & kLost) != 0;
  checkpoint.T_map_base = {in.f64(), in.f64(), in.f64()};
  checkpoint.sigma_m = in.f64();
  checkpoint.sigma_rad = in.f64();
  checkpoint.zone = in.u32();
  if (!is_place(checkpoint.T_map_base, checkpoint.sigma_m, checkpoint.sigma_rad)) {
    return ErrorCode::kBadValue;
  }
  const std::uint64_t count = in.varint();
  if (count > in.left() / 2) return ErrorCode::kBadStructure;
  for (std::uint64_t i = 0; i < count; ++i) {
    const ZoneId zone = in.varint32();
    checkpoint.resident.push_back({zone, in.varint32()});
  }
  if (!read_zones(in, checkpoint.pinned) || !read_zones(in, checkpoint.route)) {
    return ErrorCode::kBadStructure;
  }
  if ((flags & kOtherMap) != 0) {
    checkpoint.map = in.u32();
    checkpoint.offered_map = in.u32();
  }
  if (checkpoint.lost) checkpoint.sought = in.u32();
  if ((flags & kLearned) != 0) {
    const ByteSpan learned = in.bytes(in.varint());
    checkpoint.transitions.assign(learned.begin(), learned.end());
  }
  if (!in.finished()) return ErrorCode::kBadStructure;
  return checkpoint;
}

RunMirror::RunMirror(std::size_t zones) : zones_(zones) {}

void RunMirror::use(ZoneId zone) {
  if (zones_[zone].used != 0) zones_[zone].used = ++clock_;
}

void RunMirror::change_map(std::uint32_t map, std::size_t zones) {
  map_ = map;
  zones_.assign(zones, {});
  pinned_.clear();
  route_.clear();
}

void RunMirror::on_event(const Event& event) {
  if (event.kind == EventKind::kMapChanged || event.kind == EventKind::kMapRefused) {
    offered_map_ = 0;
  }
  if (event.zone >= zones_.size()) return;
  switch (event.kind) {
    case EventKind::kLoadDone:
    case EventKind::kZoneKept:
      zones_[event.zone] = {++clock_, event.generation};
      break;
    case EventKind::kEvicted:
      zones_[event.zone] = {};
      break;
    case EventKind::kZoneEntered: {
      // What lies behind is not searched again: a route may lead through a zone twice.
      const auto here = std::ranges::find(route_, event.zone);
      if (here != route_.end()) route_.erase(route_.begin(), here);
      use(event.zone);
      break;
    }
    case EventKind::kZoneWanted:
    case EventKind::kZoneUnwanted:
      use(event.zone);
      break;
    default:
      break;
  }
}

void RunMirror::on_commands(std::span<const Command> commands) {
  for (const Command& command : commands) {
    switch (command.kind) {
      case Command::Kind::kPin:
        if (command.zone < zones_.size() && std::ranges::count(pinned_, command.zone) == 0) {
          pinned_.push_back(command.zone);
        }
        break;
      case Command::Kind::kUnpin:
        std::erase(pinned_, command.zone);
        break;
      case Command::Kind::kFreeze:
      case Command::Kind::kUnfreeze:
        frozen_ = command.kind == Command::Kind::kFreeze;
        break;
      case Command::Kind::kRouteHint:
        route_.assign(command.route.begin(), command.route.begin() + command.route_length);
        break;
      case Command::Kind::kLease:
      case Command::Kind::kRelease:
      case Command::Kind::kMapFreed:
      case Command::Kind::kLost:
      case Command::Kind::kSeek:
      case Command::Kind::kAskTurn:
        break;
    }
  }
}

void RunMirror::on_edges(std::span<const LineEdge> edges) {
  for (const LineEdge& edge : edges) {
    if (edge.line == LineEdge::kHold) held_ = edge.active;
  }
}

void RunMirror::describe(Checkpoint& checkpoint) const {
  checkpoint.resident.clear();
  if (checkpoint.map != map_) return;
  checkpoint.offered_map = offered_map_;
  for (ZoneId zone = 0; zone < zones_.size(); ++zone) {
    if (zones_[zone].used != 0) checkpoint.resident.push_back({zone, zones_[zone].generation});
  }
  std::ranges::sort(checkpoint.resident, {},
                    [&](const Checkpoint::Held& held) { return zones_[held.zone].used; });
  checkpoint.pinned = pinned_;
  checkpoint.route = route_;
  checkpoint.frozen = frozen_;
  checkpoint.held = held_;
}

}  // namespace zonepack
