// SPDX-License-Identifier: Apache-2.0
#include "runtime/zones/transitions_file.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "platform/base/require.hpp"
#include "runtime/pack_format/file/small_file.hpp"
#include "runtime/pack_format/file/zone_name.hpp"

namespace zonepack {
namespace {

constexpr std::uint8_t kMagic[8] = {0x89, 'Z', 'P', 'T', '\r', '\n', 0x1A, '\n'};
constexpr std::uint16_t kMajor = 1, kMinor = 0;
constexpr std::size_t kMostNames = Transitions::kMostContexts * (2 + Successors::kMost);

// Two zones, an age and a count; then for each successor a zone, a count, a time and an age.
constexpr std::size_t kMostContextBytes = 16 + Successors::kMost * 20;
constexpr std::size_t kFixedBytes = 128;

Failure refuse(ErrorCode code, std::string why) { return failure(std::move(why), code); }

Outcome<ByteSpan> content_of(ByteSpan file) {
  ByteReader header(file);
  for (const std::uint8_t byte : kMagic) {
    if (header.u8() == byte) continue;
    return refuse(header.ok() ? ErrorCode::kBadMagic : ErrorCode::kTruncated,
                  "is no file of transitions; expected one as zoned learn writes it");
  }
  const std::uint16_t major = header.u16();
  header.u16();
  const std::uint32_t size = header.u32();
  const std::uint64_t checksum = header.u64();
  if (!header.ok()) return refuse(ErrorCode::kTruncated, "ends within its header");
  if (major != kMajor) {
    return refuse(ErrorCode::kBadVersion, "is of version " + std::to_string(major) +
                                              ", this zoned reads version " +
                                              std::to_string(kMajor) + "; learn it again");
  }
  if (size > header.left()) {
    return refuse(ErrorCode::kTruncated, "holds " + std::to_string(header.left()) + " of " +
                                             std::to_string(size) + " bytes; copy it again");
  }
  const ByteSpan content = header.bytes(size);
  if (xxh3(content) != checksum) {
    return refuse(ErrorCode::kBadChecksum,
                  "is damaged (checksum); copy it again, or learn it again");
  }
  return content;
}

Outcome<void> read_names(ByteReader& in, LearnedTransitions& learned) {
  const std::uint64_t count = in.varint();
  if (count > kMostNames || count > in.left()) {
    return refuse(ErrorCode::kTooLarge, "names " + std::to_string(count) + " zones, at most " +
                                            std::to_string(kMostNames) + " can be");
  }
  for (std::uint64_t i = 0; i < count; ++i) {
    const ByteSpan bytes = in.bytes(in.u8());
    std::string name(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (!in.ok() || name_fault(name) || (i > 0 && name <= learned.zones.back())) {
      return refuse(ErrorCode::kBadValue,
                    "zone " + std::to_string(i) + ": is no name, or not after the one before it");
    }
    learned.zones.push_back(std::move(name));
  }
  return {};
}

bool read_entries(ByteReader& in, std::uint64_t zones, std::uint32_t steps,
                  Transitions::Context& context) {
  const std::uint8_t count = in.u8();
  if (count == 0 || count > Successors::kMost) return false;
  for (std::uint8_t k = 0; k < count; ++k) {
    Transitions::Entry& entry = context.next[k];
    entry.zone = in.varint32();
    entry.count = in.varint32();
    entry.milliseconds = in.varint32();
    entry.seen = steps - in.varint32();
    if (!in.ok() || entry.zone >= zones || entry.count == 0 ||
        entry.count > Transitions::kMostCount ||
        entry.milliseconds > Transitions::kMostMilliseconds)
      return false;
    for (std::uint8_t other = 0; other < k; ++other) {
      if (context.next[other].zone == entry.zone) return false;
    }
  }
  return true;
}

Outcome<void> read_contexts(ByteReader& in, LearnedTransitions& learned) {
  const std::uint64_t count = in.varint();
  if (count > Transitions::kMostContexts || count > in.left()) {
    return refuse(ErrorCode::kTooLarge, "holds " + std::to_string(count) + " contexts, at most " +
                                            std::to_string(Transitions::kMostContexts) + " can be");
  }
  const std::uint64_t zones = learned.zones.size();
  for (std::uint64_t i = 0; i < count; ++i) {
    Transitions::Context context;
    const std::uint32_t before = in.varint32();
    context.before = before == 0 ? kNoZone : before - 1;
    context.now = in.varint32();
    context.seen = learned.steps - in.varint32();
    const bool known = before <= zones && context.now < zones;
    const bool first = learned.contexts.empty();
    const auto key = [](const Transitions::Context& c) { return std::pair(c.before, c.now); };
    if (!in.ok() || !known || !read_entries(in, zones, learned.steps, context) ||
        (!first && key(context) <= key(learned.contexts.back()))) {
      return refuse(ErrorCode::kBadValue,
                    "context " + std::to_string(i) +
                        ": a zone, count or time is out of its range, or it is out of order");
    }
    learned.contexts.push_back(context);
  }
  return {};
}

}  // namespace

bool operator==(const LearnedTransitions& a, const LearnedTransitions& b) {
  return write_transitions(a) == write_transitions(b);
}

void restore(const LearnedTransitions& learned, Transitions& into) {
  std::vector<ZoneId> here;
  here.reserve(learned.zones.size());
  for (const std::string& name : learned.zones) here.push_back(into.graph().find(name));
  into.continue_steps(learned.steps);
  for (const Transitions::Context& theirs : learned.contexts) {
    Transitions::Context context;
    if (theirs.before != kNoZone) {
      context.before = here[theirs.before];
      if (context.before == kNoZone) continue;
    }
    context.now = here[theirs.now];
    context.seen = theirs.seen;
    std::size_t size = 0;
    for (const Transitions::Entry& entry : theirs.next) {
      if (entry.zone == kNoZone) break;
      const ZoneId zone = here[entry.zone];
      if (!joined(into.graph(), context.now, zone)) continue;
      context.next[size] = entry;
      context.next[size++].zone = zone;
    }
    into.restore(context);
  }
}

LearnedTransitions save(const Transitions& transitions) {
  LearnedTransitions learned;
  learned.steps = transitions.steps();
  std::vector<ZoneId> used;
  for (const Transitions::Context& context : transitions.contexts()) {
    if (context.before != kNoZone) used.push_back(context.before);
    used.push_back(context.now);
    for (std::size_t i = 0; i < context.size(); ++i) used.push_back(context.next[i].zone);
  }
  // Zones come sorted by name, so ascending ids are ascending names.
  std::ranges::sort(used);
  used.erase(std::unique(used.begin(), used.end()), used.end());
  const auto index = [&](ZoneId zone) {
    return static_cast<ZoneId>(std::ranges::lower_bound(used, zone) - used.begin());
  };
  for (const ZoneId zone : used) learned.zones.push_back(transitions.graph().name(zone));
  for (Transitions::Context context : transitions.contexts()) {
    if (context.before != kNoZone) context.before = index(context.before);
    context.now = index(context.now);
    for (std::size_t i = 0; i < context.size(); ++i) {
      context.next[i].zone = index(context.next[i].zone);
    }
    learned.contexts.push_back(context);
  }
  return learned;
}

std::vector<std::byte> write_transitions(const LearnedTransitions& learned) {
  std::size_t room =
      kSmallFileHeaderBytes + kFixedBytes + learned.contexts.size() * kMostContextBytes;
  for (const std::string& name : learned.zones) room += name.size() + 1;
  ZP_REQUIRE(room >= kSmallFileHeaderBytes + kFixedBytes);
  std::vector<std::byte> file(room);
  ByteWriter out(std::span<std::byte>(file).subspan(kSmallFileHeaderBytes));
  out.bytes(std::as_bytes(std::span(learned.map_lineage)));
  out.bytes(std::as_bytes(std::span(learned.map_version)));
  out.bytes(std::as_bytes(std::span(learned.origin)));
  out.u32(learned.steps);
  out.varint(learned.zones.size());
  for (const std::string& name : learned.zones) {
    out.u8(static_cast<std::uint8_t>(name.size()));
    out.bytes(std::as_bytes(std::span(name)));
  }
  out.varint(learned.contexts.size());
  for (const Transitions::Context& context : learned.contexts) {
    out.varint(context.before == kNoZone ? 0 : std::uint64_t{context.before} + 1);
    out.varint(context.now);
    out.varint(learned.steps - context.seen);
    const std::size_t size = context.size();
    out.u8(static_cast<std::uint8_t>(size));
    for (std::size_t i = 0; i < size; ++i) {
      const Transitions::Entry& entry = context.next[i];
      out.varint(entry.zone);
      out.varint(entry.count);
      out.varint(entry.milliseconds);
      out.varint(learned.steps - entry.seen);
    }
  }
  complete_small_file(file, kMagic, kMajor, kMinor, out);
  return file;
}

Outcome<LearnedTransitions> read_transitions(ByteSpan file) {
  const auto content = content_of(file);
  if (!content) return content.error();
  LearnedTransitions learned;
  ByteReader in(*content);
  read_digest(in, learned.map_lineage);
  read_digest(in, learned.map_version);
  read_digest(in, learned.origin);
  learned.steps = in.u32();
  if (!in.ok()) return refuse(ErrorCode::kBadStructure, "ends before its zones");
  if (const auto read = read_names(in, learned); !read) return read.error();
  if (const auto read = read_contexts(in, learned); !read) return read.error();
  return learned;
}

}  // namespace zonepack
