// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "runtime/map/catalog.hpp"
#include "runtime/recording/recording_reader.hpp"
#include "runtime/replay/replay.hpp"
#include "runtime/settings/settings.hpp"

namespace zonepack {

struct RecordedRunResult {
  ReplayResult replay;
  std::uint64_t first_cycle = 0;
  std::uint64_t next_cycle = 0;  // after the last
  bool complete = false;         // every cycle up to the end, or to when it was saved
  bool exact = true;             // false: begun from a checkpoint
  std::string live_hash;         // the event log's, when it ran; empty: not recorded
};

// Opens what a recording holds of settings and map: what replay_recording() works on. A complete
// message in `fault`, or nothing.
struct RecordedRun {
  Settings settings;
  Catalog catalog;
};
std::optional<RecordedRun> open_recorded_run(const RecordingPreface& preface, std::string& fault);

// Drives what was recorded through the cycle. From its beginning, the events are those of the run,
// byte for byte. From a checkpoint, the run goes on as from a guess: loads take the time of the
// model, and until the first fixes decisions may differ from those of the run.
// Nothing when the recording contradicts itself or the cycle (another program version, a forged
// file): `fault` then names the cycle.
std::optional<RecordedRunResult> replay_recording(RecordingReader& recording,
                                                  const RecordedRun& run,
                                                  const std::string& events_path,
                                                  std::string& fault);

}  // namespace zonepack
