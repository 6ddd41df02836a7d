// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "runtime/evaluate/bounds.hpp"
#include "runtime/evaluate/drive_account.hpp"
#include "runtime/evaluate/drives.hpp"
#include "runtime/evaluate/policies/eviction_names.hpp"
#include "runtime/evaluate/preload_modes.hpp"
#include "runtime/run/figures/run_summary.hpp"
#include "runtime/run/figures/run_trace.hpp"
#include "runtime/run/inputs/run_inputs.hpp"

namespace zonepack {

// A map that drives are replayed on, with the robot's settings.
struct EvaluatedMap {
  std::string name;  // as given
  Catalog catalog;
  std::vector<std::vector<TimedCommand>> commands;  // by drive
};

// One combination of everything that is compared.
struct Choice {
  std::size_t map = 0, drive = 0;
  std::optional<ByteCount> budget;  // nothing: the whole map, limited by max_signatures
  std::uint64_t max_signatures = 0;
  const NamedEviction* eviction = nullptr;
  const PreloadMode* preload = nullptr;
  std::uint64_t storage_rate = 0;
  bool curves = false;       // keep the trace for the report
  bool order_trace = false;  // keep the calls of the eviction order, as CSV
};

// How it went.
struct Evaluated {
  RunSummary summary;
  std::uint64_t requests = 0, hits = 0, entered = 0;
  ByteCount bytes_read = 0, bytes_unused = 0;
  DriveAccount::Foreseen foreseen;
  LoadTotals farthest, least;
  RunTrace trace;         // with Choice::curves
  std::string order_csv;  // with Choice::order_trace
};

// What all runs have in common. Immutable while they run.
struct Evaluation {
  Settings settings;
  std::vector<EvaluatedMap> maps;
  std::vector<Drive> drives;
  std::shared_ptr<const LearnedTransitions> learned;  // of preload.transitions; null: none
};

// The terms on which a choice holds its map.
MapTerms terms_of(const Evaluation& evaluation, const Choice& choice);

// Replays a drive with modelled loads. Nothing is measured: the result depends on the choice alone.
//
// Threads: any number at once.
Outcome<Evaluated> evaluate(const Evaluation& evaluation, const Choice& choice);

}  // namespace zonepack
