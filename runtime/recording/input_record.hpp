// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "platform/base/result.hpp"
#include "runtime/control/cycle.hpp"
#include "runtime/recording/bytes.hpp"

// The inputs of one cycle, laid out as RECORDING.md says under "Records".
namespace zonepack {

enum class RecordKind : std::uint8_t {
  kFrames = 1,
  kCorrections = 2,
  kLoads = 3,
  kCommands = 4,
  kOffer = 5,
  kEdges = 6,
  kViews = 7,
  kKeeps = 8,
};
// A reader may skip unknown records of this kind and above; any other unknown record is an input
// that would be missing.
inline constexpr std::uint8_t kFirstNoteKind = 128;

inline constexpr std::size_t kMostRecordedFrames = 4096;
inline constexpr std::size_t kMostRecordedCorrections = 4096;
inline constexpr std::size_t kMostRecordedLoads = 1024;
inline constexpr std::size_t kMostRecordedEdges = 1024;
inline constexpr std::size_t kMostCycleBytes = std::size_t{512} * 1024;  // of one cycle's records

// Room for the records of any cycle with at most that many frames, full commands and up to 64
// corrections, loads and edges.
std::size_t record_room(std::uint32_t most_frames) noexcept;

// Writes the records of a cycle; nothing for a cycle without input. ok() of `out` says whether they
// fit. Of a load's slots only the count is recorded.
// Real-time: no allocation; work bounded by the input.
void write_records(const CycleInput& input, ByteWriter& out) noexcept;

// A cycle's inputs read back.
struct RecordedInput {
  std::int64_t now_ns = 0;
  std::vector<CanFrame> frames;
  std::vector<PoseCorrection> corrections;
  std::vector<LoadResult> loads;  // slots: {0, 0, count}
  std::vector<Command> commands;
  std::vector<LineEdge> edges;

  MapOffer offer;

  CycleInput view() const noexcept {
    return {now_ns, frames, corrections, loads, commands, offer, edges};
  }
};

// Replaces all but now_ns, to which stamps are relative. kBadStructure for what write_records does
// not write, kBadVersion (detail: the kind) for an input of an unknown kind.
Result<void> read_records(ByteSpan records, RecordedInput& into);

}  // namespace zonepack
