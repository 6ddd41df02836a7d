// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "platform/base/result.hpp"
#include "runtime/odometry/pose.hpp"
#include "runtime/pack_format/limits.hpp"
#include "runtime/recording/bytes.hpp"
#include "runtime/run/inputs/run_start.hpp"
#include "runtime/run/maps/map_model.hpp"
#include "runtime/zones/transitions_file.hpp"

namespace zonepack {

// What a run decides on besides the inputs of its cycles, so that a recording needs neither map nor
// settings file.
struct RecordingPreface {
  std::string program;              // version that recorded
  std::int64_t realtime_ns = 0;     // CLOCK_REALTIME at the start; 0: unknown
  std::string settings_path;        // for messages, and what its relative paths refer to
  std::string settings;             // the file's text
  std::string dbc;                  // the text of the file that can.dbc names; empty: none
  std::string map_folder;           // for messages
  std::vector<std::byte> manifest;  // the file's bytes
  MapTerms terms;                   // as the run had them, command line included
  std::optional<RunStart> start;
};

// Passes the blocks that hold the preface to take_block, in order.
void write_preface(const RecordingPreface& preface,
                   const std::function<void(ByteSpan block)>& take_block);

// Reads the contents of these blocks, joined. kBadStructure; kBadVersion (detail: the field) for an
// unknown field.
Result<RecordingPreface> read_preface(ByteSpan content);

// Contents longer than this are refused: the largest manifest, and room for the texts.
inline constexpr std::uint64_t kMostPrefaceBytes = kMaxManifestBytes + 4 * kMiB;

}  // namespace zonepack
