// SPDX-License-Identifier: Apache-2.0
#include "runtime/serve/answers.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "platform/base/require.hpp"

namespace zonepack {
namespace {

using flatbuffers::FlatBufferBuilder;
using flatbuffers::Offset;

// A page is full when this much of a message is used: whatever may follow fits in the rest.
constexpr std::size_t kPageBytes = kMostMessageBytes - 2048;
constexpr std::size_t kMostChanges = 1000;
constexpr std::size_t kMostRouteZones = 128;
constexpr std::size_t kMostOutlinePoints = 128;  // 1 KiB: fits after a full page

static_assert(static_cast<int>(wire::EventKind::ZoneKept) ==
              static_cast<int>(EventKind::kZoneKept));
static_assert(static_cast<int>(wire::ZoneState::Resident) ==
              static_cast<int>(ZoneState::kResident));

Offset<flatbuffers::String> text(FlatBufferBuilder& builder, std::string_view words) {
  return builder.CreateString(words.data(), std::min(words.size(), kMostNameBytes));
}

Offset<wire::Zone> zone_row(FlatBufferBuilder& builder, const ServedMap& map, ZoneId zone) {
  const CatalogZone& entry = map.catalog.zones[zone];
  const ZoneTable::Row& row = map.zones[zone];
  const ZoneActivity::Row active = map.activity.of(zone);
  const auto name = text(builder, entry.name);
  const auto type = text(builder, entry.zone_type);
  const ByteCount bytes = entry.slots * (kSlotBytes + kTableBytesPerSlot);
  return wire::CreateZone(builder, zone, name, type, entry.signatures, bytes, row.generation,
                          static_cast<wire::ZoneState>(row.state), row.wanted, row.pinned,
                          row.leases, active.loads, active.evictions, active.entered,
                          active.last_load_ns);
}

wire::Signature signature_row(const fb::Node& node, ZoneId zone, double distance_m) {
  return {
      node.x(), node.y(), node.z(), node.yaw(), node.id(), zone, static_cast<float>(distance_m)};
}

Offset<wire::Event> event_row(FlatBufferBuilder& builder, const ServedMap& map,
                              const Event& event) {
  const bool known = event.zone < map.catalog.zones.size();
  const auto name =
      known ? text(builder, map.catalog.zones[event.zone].name) : Offset<flatbuffers::String>();
  const auto reason =
      event.reason != nullptr ? text(builder, event.reason) : Offset<flatbuffers::String>();
  return wire::CreateEvent(builder, static_cast<wire::EventKind>(event.kind), event.cycle,
                           event.t_ns, event.zone, name, event.generation, event.signatures,
                           event.bytes, event.charged_signatures, event.charged_bytes, reason,
                           event.has_pose, event.x_mm, event.y_mm, event.yaw_mrad);
}

}  // namespace

Message answer_zones(MessageBuilder& to, std::uint64_t id, const ServedMap& map,
                     std::uint32_t first, bool active_only) {
  FlatBufferBuilder& builder = to.builder();
  const auto total = static_cast<std::uint32_t>(map.catalog.zones.size());
  std::vector<Offset<wire::Zone>> rows;
  if (active_only) {
    for (const ZoneActivity::Row& row : map.activity.rows()) {
      if (row.zone < first || row.zone >= total) continue;
      if (builder.GetSize() + 4 * rows.size() >= kPageBytes) break;
      rows.push_back(zone_row(builder, map, row.zone));
    }
    return to.reply(
        id, wire::CreateZones(builder, first, total, builder.CreateVector(rows), map.epoch));
  }
  for (ZoneId zone = first; zone < total && builder.GetSize() + 4 * rows.size() < kPageBytes;
       ++zone) {
    rows.push_back(zone_row(builder, map, zone));
  }
  return to.reply(id,
                  wire::CreateZones(builder, first, total, builder.CreateVector(rows), map.epoch));
}

Message answer_outlines(MessageBuilder& to, std::uint64_t id, const ServedMap& map,
                        std::uint32_t first) {
  FlatBufferBuilder& builder = to.builder();
  const auto total = static_cast<std::uint32_t>(map.catalog.zones.size());
  std::vector<Offset<wire::Outline>> rows;
  for (ZoneId zone = first; zone < total && builder.GetSize() + 4 * rows.size() < kPageBytes;
       ++zone) {
    const Ring& ring = map.catalog.zones[zone].polygon.outer;
    const std::size_t step = (ring.size() + kMostOutlinePoints - 1) / kMostOutlinePoints;
    std::vector<wire::OutlinePoint> points;
    for (std::size_t i = 0; i < ring.size(); i += step) {
      points.emplace_back(static_cast<float>(ring[i].x_m), static_cast<float>(ring[i].y_m));
    }
    rows.push_back(wire::CreateOutline(builder, zone, builder.CreateVectorOfStructs(points)));
  }
  return to.reply(id, wire::CreateOutlines(builder, first, total, builder.CreateVector(rows)));
}

Message answer_zone(MessageBuilder& to, std::uint64_t id, const ServedMap& map, ZoneId zone) {
  return to.reply(id, zone_row(to.builder(), map, zone));
}

Message answer_changes(MessageBuilder& to, std::uint64_t id, const ServedMap& map,
                       std::uint64_t since) {
  const ZoneTable& zones = map.zones;
  const bool restarted = since > zones.counter();
  std::vector<wire::ZoneChange> changes;
  std::uint64_t counter = restarted ? 0 : since;
  ZoneId zone = zones.first_changed_after(counter);
  for (; zone != kNoZone && changes.size() < kMostChanges; zone = zones[zone].newer) {
    changes.emplace_back(zone, zones[zone].generation, zones[zone].resident());
    counter = zones[zone].changed_at;
  }
  const auto list = to.builder().CreateVectorOfStructs(changes);
  return to.reply(id, wire::CreateChanges(to.builder(), counter, zone != kNoZone, restarted, list));
}

Message answer_signatures(MessageBuilder& to, std::uint64_t id, ServedMap& map, ZoneId zone,
                          std::uint32_t first) {
  if (!map.nodes) return to.fault(id, wire::Fault::Unavailable, "the manifest cannot be read");
  std::vector<wire::Signature> rows;
  const std::uint32_t total = map.nodes->count(zone);
  if (total == 0 && map.catalog.zones[zone].signatures > 0) {
    return to.fault(id, wire::Fault::Unavailable, "this map was packed without coarse poses");
  }
  if (first < total) {
    const auto nodes = map.nodes->read(zone, first);
    if (!nodes) return to.fault(id, wire::Fault::Failed, to_string(nodes.error().code));
    for (const fb::Node& node : *nodes) rows.push_back(signature_row(node, zone, 0));
  }
  const ZoneTable::Row& row = map.zones[zone];
  const auto list = to.builder().CreateVectorOfStructs(rows);
  return to.reply(id, wire::CreateSignatures(to.builder(), zone, first, total, row.resident(),
                                             row.generation, list));
}

Message answer_nearest(MessageBuilder& to, std::uint64_t id, ServedMap& map,
                       const wire::AskNearest& ask) {
  if (!std::isfinite(ask.x()) || !std::isfinite(ask.y()) ||
      !(ask.radius() >= 0 && ask.radius() <= kMostNearestRadius_m) || ask.most() == 0 ||
      ask.most() > kMostNearest) {
    return to.fault(id, wire::Fault::Malformed, "expected radius 0 to 1000 m, most 1 to 64");
  }
  if (!map.nodes) return to.fault(id, wire::Fault::Unavailable, "the manifest cannot be read");
  std::vector<NodeStore::Found> found;
  const auto complete = map.nodes->nearest(
      {{ask.x(), ask.y()}, ask.radius(), ask.most()},
      [&](ZoneId zone) { return !ask.resident_only() || map.zones[zone].resident(); }, found);
  if (!complete) return to.fault(id, wire::Fault::Failed, to_string(complete.error().code));
  std::vector<wire::Signature> rows;
  rows.reserve(found.size());
  for (const NodeStore::Found& entry : found) {
    rows.push_back(signature_row(entry.node, entry.zone, entry.distance_m));
  }
  const auto list = to.builder().CreateVectorOfStructs(rows);
  return to.reply(id, wire::CreateNearest(to.builder(), *complete, list));
}

Message answer_route(MessageBuilder& to, std::uint64_t id, const ServedMap& map, const Route& route,
                     bool hinted) {
  FlatBufferBuilder& builder = to.builder();
  const std::size_t count = std::min(route.zones.size(), kMostRouteZones);
  std::vector<Offset<flatbuffers::String>> names;
  std::vector<wire::Place> doors;
  for (std::size_t i = 0; i < count; ++i) {
    names.push_back(text(builder, map.catalog.zones[route.zones[i]].name));
    if (i + 1 < count) doors.emplace_back(route.doors[i].x_m, route.doors[i].y_m);
  }
  const auto zones = builder.CreateVector(route.zones.data(), count);
  const auto name_list = builder.CreateVector(names);
  const auto door_list = builder.CreateVectorOfStructs(doors);
  return to.reply(id, wire::CreateRoute(builder, route.length_m, zones, name_list, door_list,
                                        count < route.zones.size(), hinted));
}

Message events_notice(MessageBuilder& to, const ServedMap& map, std::span<const Event>& events) {
  FlatBufferBuilder& builder = to.builder();
  std::vector<Offset<wire::Event>> rows;
  std::size_t count = 0;
  for (; count < events.size() && builder.GetSize() + 4 * rows.size() < kPageBytes; ++count) {
    rows.push_back(event_row(builder, map, events[count]));
  }
  events = events.subspan(count);
  return to.reply(0, wire::CreateEvents(builder, builder.CreateVector(rows)));
}

wire::Fault fault_of(const Error& error) noexcept {
  switch (error.code) {
    case ErrorCode::kOk:
      return wire::Fault::None;
    case ErrorCode::kNotFound:
      return wire::Fault::NotFound;
    case ErrorCode::kNoRoom:
      return wire::Fault::NoRoom;
    case ErrorCode::kBusy:
      return wire::Fault::Busy;
    case ErrorCode::kTooLarge:
      return wire::Fault::TooMany;
    default:
      return wire::Fault::Failed;
  }
}

Message no_such_zone(MessageBuilder& to, std::uint64_t id, std::uint32_t zone,
                     const flatbuffers::String* name) {
  const std::string which = name != nullptr
                                ? "\"" + std::string(view_of(name).substr(0, kMostNameBytes)) + "\""
                                : std::to_string(zone);
  return to.fault(id, wire::Fault::NotFound, "no zone " + which + " in this map");
}

}  // namespace zonepack
