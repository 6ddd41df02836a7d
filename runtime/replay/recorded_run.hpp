// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
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

// The settings and the first map of a recording: what replay_recording() works on.
struct RecordedRun {
  Settings settings;
  Catalog catalog;
};
Outcome<RecordedRun> open_recorded_run(const RecordingPreface& preface);

// Drives what was recorded through a run. From its beginning, the events are those of the run,
// byte for byte. From a checkpoint, the run goes on as from a guess: loads take the time of the
// model, and until the first fixes decisions may differ from those of the run.
// observer: watches; may be null. Fails, naming the cycle, when the recording contradicts itself or
// the cycle (another program version, a forged file).
Outcome<RecordedRunResult> replay_recording(RecordingReader& recording, const RecordedRun& run,
                                            const std::string& events_path,
                                            RunObserver* observer = nullptr);

}  // namespace zonepack
