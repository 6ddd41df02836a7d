// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "runtime/run/run.hpp"
#include "runtime/zones/transitions_file.hpp"

namespace zonepack {

// What a run with preload.learn begins with: what an earlier one saved in the folder of the state,
// if it went on from the same file on this map, else `given` (null: nothing). A saved file that is
// not used is named in `notes`.
std::shared_ptr<const LearnedTransitions> go_on_learning(
    const std::string& folder, const std::shared_ptr<const LearnedTransitions>& given,
    const Digest16& map_lineage, std::vector<std::string>& notes);

// Counts the steps of a live run as its cycle does, from its events, so that they can be saved
// while the control thread goes on. Events that were lost are not counted.
//
// Threads: on_event() one; all else any.
class HabitKeeper final : public RunObserver {
 public:
  static constexpr std::int64_t kPeriod_ns = 60'000'000'000;

  // folder: empty: nothing is saved. begin: what the run began with; may be null.
  HabitKeeper(std::string folder, const std::shared_ptr<const LearnedTransitions>& begin);

  void on_event(const Event& event, const MapVersion& map) noexcept override;

  // The file as it would be now; empty before the first step.
  std::vector<std::byte> file() const;

  // Saves what is new, at most once in kPeriod_ns unless `at_end`. now_ns: CLOCK_MONOTONIC.
  Result<void> save(std::int64_t now_ns, bool at_end);

 private:
  const std::string folder_;
  mutable std::mutex mutex_;  // guards all that follows
  LearnedTransitions learned_;
  std::optional<Transitions> table_;  // of the map of this number
  std::uint32_t map_ = 0;
  ZoneSteps steps_;
  bool changed_ = false;
  std::int64_t saved_ns_ = 0;
};

}  // namespace zonepack
