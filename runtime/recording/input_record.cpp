// SPDX-License-Identifier: Apache-2.0
#include "runtime/recording/input_record.hpp"

#include <algorithm>

namespace zonepack {
namespace {

// A new member of these must be written and read below, or a recording would not hold it. (Not
// Command::map: a command for another map never becomes an input.)
static_assert(sizeof(Command) == 296 && sizeof(LoadResult) == 40 && sizeof(PoseCorrection) == 72 &&
              sizeof(LineEdge) == 16);

constexpr std::uint8_t kExtended = 1, kFd = 2, kRtr = 4, kErrorFrame = 8, kHasFlags = 16;
constexpr std::size_t kFrameRoom = 5 + 10 + 5 + 64;
constexpr std::size_t kOtherRoom = std::size_t{32} * 1024;
constexpr std::size_t kLongestData = 64;

std::size_t data_bytes(const CanFrame& frame) noexcept {
  return frame.rtr ? 0 : std::min<std::size_t>(frame.len, kLongestData);
}

void write_frames(const CycleInput& input, ByteWriter& out) noexcept {
  std::int64_t before_ns = input.now_ns;
  for (const CanFrame& frame : input.frames) {
    const unsigned bits = (frame.extended ? kExtended : 0u) | (frame.fd ? kFd : 0u) |
                          (frame.rtr ? kRtr : 0u) | (frame.error ? kErrorFrame : 0u) |
                          (frame.flags != 0 ? kHasFlags : 0u);
    out.u8(static_cast<std::uint8_t>(bits));
    if (frame.flags != 0) out.u8(frame.flags);
    out.zigzag(wrapped_sub(frame.stamp_ns, before_ns));
    before_ns = frame.stamp_ns;
    out.varint(frame.id);
    out.u8(frame.len);
    out.bytes(std::as_bytes(std::span(frame.data)).first(data_bytes(frame)));
  }
}

void write_corrections(const CycleInput& input, ByteWriter& out) noexcept {
  for (const PoseCorrection& fix : input.corrections) {
    out.zigzag(wrapped_sub(fix.stamp_ns, input.now_ns));
    out.zigzag(wrapped_sub(fix.received_ns, input.now_ns));
    for (const double value : {fix.T_map_base.x_m, fix.T_map_base.y_m, fix.T_map_base.yaw_rad,
                               fix.sigma_x_m, fix.sigma_y_m, fix.sigma_yaw_rad}) {
      out.f64(value);
    }
  }
}

void write_views(const CycleInput& input, ByteWriter& out) noexcept {
  for (const PoseCorrection& fix : input.corrections) out.f64(fix.view_m);
}

void write_loads(const CycleInput& input, ByteWriter& out) noexcept {
  for (const LoadResult& load : input.loads) {
    out.varint(load.zone);
    out.varint(load.generation);
    out.varint(static_cast<std::uint16_t>(load.error.code));
    out.zigzag(load.error.detail);
    out.varint(load.slots.count);
  }
}

void write_commands(const CycleInput& input, ByteWriter& out) noexcept {
  for (const Command& command : input.commands) {
    out.u8(static_cast<std::uint8_t>(command.kind));
    out.varint(command.id);
    out.varint(command.zone);
    out.varint(command.lease.zone);
    out.varint(command.lease.generation);
    out.varint(command.lease.epoch);
    const std::size_t route = std::min<std::size_t>(command.route_length, Command::kMostRoute);
    out.varint(route);
    for (std::size_t i = 0; i < route; ++i) out.varint(command.route[i]);
  }
}

void write_edges(const CycleInput& input, ByteWriter& out) noexcept {
  for (const LineEdge& edge : input.edges) {
    out.varint(edge.line);
    out.u8(edge.active ? 1 : 0);
    out.zigzag(wrapped_sub(edge.stamp_ns, input.now_ns));
  }
}

void write_offer(const CycleInput& input, ByteWriter& out) noexcept {
  out.varint(input.offer.map);
  out.varint(static_cast<std::uint16_t>(input.offer.fault));
}

template <typename Write>
void write_record(RecordKind kind, bool present, const CycleInput& input, ByteWriter& out,
                  Write write) noexcept {
  if (!present) return;
  out.u8(static_cast<std::uint8_t>(kind));
  const std::size_t start = out.begin_counted();
  write(input, out);
  out.end_counted(start);
}

// Reads items until the record ends; false when there are too many or one is not whole.
template <typename Item, typename Read>
bool read_items(ByteReader& in, std::vector<Item>& into, std::size_t most, Read read) {
  while (in.ok() && !in.at_end()) {
    if (into.size() == most) return false;
    if (!read(in, into.emplace_back())) return false;
  }
  return in.finished();
}

bool read_frame(ByteReader& in, std::int64_t& before_ns, CanFrame& frame) {
  const std::uint8_t bits = in.u8();
  if (bits >= 2 * kHasFlags) return false;
  frame.extended = (bits & kExtended) != 0;
  frame.fd = (bits & kFd) != 0;
  frame.rtr = (bits & kRtr) != 0;
  frame.error = (bits & kErrorFrame) != 0;
  if ((bits & kHasFlags) != 0) frame.flags = in.u8();
  frame.stamp_ns = before_ns = wrapped_add(before_ns, in.zigzag());
  frame.id = in.varint32();
  frame.len = in.u8();
  if (frame.len > kLongestData) return false;
  const ByteSpan data = in.bytes(data_bytes(frame));
  if (!data.empty()) std::memcpy(frame.data.data(), data.data(), data.size());
  return in.ok();
}

bool read_correction(ByteReader& in, std::int64_t now_ns, PoseCorrection& fix) {
  fix.stamp_ns = wrapped_add(now_ns, in.zigzag());
  fix.received_ns = wrapped_add(now_ns, in.zigzag());
  for (double* const value : {&fix.T_map_base.x_m, &fix.T_map_base.y_m, &fix.T_map_base.yaw_rad,
                              &fix.sigma_x_m, &fix.sigma_y_m, &fix.sigma_yaw_rad}) {
    *value = in.f64();
  }
  return in.ok();
}

// One for each correction, which come before.
bool read_views(ByteReader& in, std::vector<PoseCorrection>& corrections) {
  for (PoseCorrection& fix : corrections) fix.view_m = in.f64();
  return in.finished();
}

bool read_code(ByteReader& in, ErrorCode& code) {
  const std::uint64_t number = in.varint();
  if (number > static_cast<std::uint16_t>(ErrorCode::kCancelled)) return false;
  code = static_cast<ErrorCode>(number);
  return true;
}

bool read_load(ByteReader& in, LoadResult& load) {
  load.zone = in.varint32();
  load.generation = in.varint32();
  if (!read_code(in, load.error.code)) return false;
  load.error.detail = in.zigzag();
  load.slots = {0, 0, in.varint32()};
  return in.ok();
}

bool read_command(ByteReader& in, Command& command) {
  const std::uint8_t kind = in.u8();
  if (kind > static_cast<std::uint8_t>(Command::Kind::kAskTurn)) return false;
  command.kind = static_cast<Command::Kind>(kind);
  command.id = in.varint();
  command.zone = in.varint32();
  command.lease.zone = in.varint32();
  command.lease.generation = in.varint32();
  command.lease.epoch = in.varint32();
  command.route_length = in.varint32();
  if (command.route_length > Command::kMostRoute) return false;
  for (std::uint32_t i = 0; i < command.route_length; ++i) command.route[i] = in.varint32();
  return in.ok();
}

bool read_edge(ByteReader& in, std::int64_t now_ns, LineEdge& edge) {
  edge.line = in.varint32();
  const std::uint8_t active = in.u8();
  edge.active = active == 1;
  edge.stamp_ns = wrapped_add(now_ns, in.zigzag());
  return in.ok() && active <= 1;
}

bool is_known(std::uint8_t kind) {
  switch (static_cast<RecordKind>(kind)) {
    case RecordKind::kFrames:
    case RecordKind::kCorrections:
    case RecordKind::kLoads:
    case RecordKind::kCommands:
    case RecordKind::kOffer:
    case RecordKind::kEdges:
    case RecordKind::kViews:
    case RecordKind::kKeeps:
      return true;
  }
  return false;
}

bool read_record(RecordKind kind, ByteReader in, RecordedInput& into) {
  switch (kind) {
    case RecordKind::kFrames: {
      std::int64_t before_ns = into.now_ns;
      return read_items(
          in, into.frames, kMostRecordedFrames,
          [&](ByteReader& item, CanFrame& frame) { return read_frame(item, before_ns, frame); });
    }
    case RecordKind::kCorrections:
      return read_items(in, into.corrections, kMostRecordedCorrections,
                        [&](ByteReader& item, PoseCorrection& fix) {
                          return read_correction(item, into.now_ns, fix);
                        });
    case RecordKind::kLoads:
      return read_items(in, into.loads, kMostRecordedLoads, read_load);
    case RecordKind::kCommands:
      return read_items(in, into.commands, Cycle::kMostCommands, read_command);
    case RecordKind::kOffer:
      into.offer.map = in.varint32();
      return read_code(in, into.offer.fault) && in.finished();
    case RecordKind::kEdges:
      return read_items(in, into.edges, kMostRecordedEdges, [&](ByteReader& item, LineEdge& edge) {
        return read_edge(item, into.now_ns, edge);
      });
    case RecordKind::kViews:
      return read_views(in, into.corrections);
    case RecordKind::kKeeps:
      into.offer.keeps = true;
      return into.offer.map != 0 && in.finished();
  }
  return false;
}

}  // namespace

std::size_t record_room(std::uint32_t most_frames) noexcept {
  return std::min(kMostCycleBytes, kOtherRoom + most_frames * kFrameRoom);
}

void write_records(const CycleInput& input, ByteWriter& out) noexcept {
  write_record(RecordKind::kFrames, !input.frames.empty(), input, out, write_frames);
  write_record(RecordKind::kCorrections, !input.corrections.empty(), input, out, write_corrections);
  const bool view = std::any_of(input.corrections.begin(), input.corrections.end(),
                                [](const PoseCorrection& fix) { return fix.view_m != 0; });
  write_record(RecordKind::kViews, view, input, out, write_views);
  write_record(RecordKind::kLoads, !input.loads.empty(), input, out, write_loads);
  write_record(RecordKind::kCommands, !input.commands.empty(), input, out, write_commands);
  const bool offered = input.offer.map != 0 || input.offer.fault != ErrorCode::kOk;
  write_record(RecordKind::kOffer, offered, input, out, write_offer);
  write_record(RecordKind::kKeeps, input.offer.map != 0 && input.offer.keeps, input, out,
               [](const CycleInput&, ByteWriter&) {});
  write_record(RecordKind::kEdges, !input.edges.empty(), input, out, write_edges);
}

Result<void> read_records(ByteSpan records, RecordedInput& into) {
  into.frames.clear();
  into.corrections.clear();
  into.loads.clear();
  into.commands.clear();
  into.offer = {};
  into.edges.clear();
  ByteReader in(records);
  while (in.ok() && !in.at_end()) {
    const std::uint8_t kind = in.u8();
    const ByteSpan content = in.bytes(in.varint());
    if (!in.ok()) break;
    if (kind >= kFirstNoteKind) continue;
    if (!is_known(kind)) return {ErrorCode::kBadVersion, kind};
    if (!read_record(static_cast<RecordKind>(kind), ByteReader(content), into)) {
      return ErrorCode::kBadStructure;
    }
  }
  if (!in.finished()) return ErrorCode::kBadStructure;
  return {};
}

}  // namespace zonepack
