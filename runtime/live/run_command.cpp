// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/run_command.hpp"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <utility>

#include "platform/base/counted.hpp"
#include "platform/files/storage.hpp"
#include "platform/process/clock.hpp"
#include "platform/process/realtime.hpp"
#include "platform/process/signals.hpp"
#include "runtime/live/cycle/live_memory.hpp"
#include "runtime/live/habit_keeper.hpp"
#include "runtime/live/live_run.hpp"
#include "runtime/map/next_version.hpp"
#include "runtime/pack_format/file/manifest_file.hpp"
#include "runtime/run/figures/summary_text.hpp"
#include "runtime/run/inputs/log_faults.hpp"
#include "runtime/run/inputs/log_time.hpp"
#include "runtime/run/output_check.hpp"
#include "runtime/settings/socket_place.hpp"

namespace zonepack {
namespace {

constexpr std::size_t kHeapBytes = 2 << 20;  // what a run takes at least, whatever the map

constexpr const char* kProgram = "zoned run";

void warn(const std::string& message) { std::cerr << kProgram << ": warning: " << message << '\n'; }

std::uint32_t zones_with_room_for_another_map(std::size_t zones) {
  return static_cast<std::uint32_t>(zones + std::max<std::size_t>(zones / 4, 16));
}

// The settings' folder, else the one that the service manager made for us.
std::string state_folder(const Settings& settings) {
  if (!settings.state.folder.empty()) return settings.state.folder;
  const char* const given = std::getenv("STATE_DIRECTORY");
  const std::string folders = given != nullptr ? given : "";
  return folders.substr(0, folders.find(':'));
}

// What a recording says before its first cycle.
Outcome<RecordingPreface> make_preface(const RunArguments& arguments, const RunInputs& inputs,
                                       const Catalog& catalog, const MapTerms& terms) {
  RecordingPreface preface;
  preface.program = arguments.program;
  preface.realtime_ns = realtime_ns();
  preface.settings_path = arguments.config;
  preface.settings = inputs.settings_text;
  preface.dbc = inputs.settings.can.dbc_text;
  preface.map_folder = catalog.folder;
  preface.terms = terms;
  const std::string path = catalog.folder + "/" + std::string(kManifestName);
  auto manifest = read_manifest_file(catalog.folder, catalog.reading_bytes, ReadMode::kBuffered);
  if (!manifest || manifest_digest(*manifest) != catalog.version) {
    return failure(path + ": changed while zoned was starting; start it again",
                   ErrorCode::kMismatch);
  }
  preface.manifest = std::move(manifest).value();
  return preface;
}

Notifier service_manager() {
  auto manager = Notifier::from_environment();
  if (manager) return std::move(*manager);
  std::cerr << kProgram
            << ": NOTIFY_SOCKET: cannot be reached, so the service manager is not notified\n";
  return {};
}

// The end of a run: writes what is left to write while the guard still watches.
Outcome<void> conclude(const RunArguments& arguments, LiveRun& run) {
  Failures failed;
  auto summary = run.finish(failed);
  if (!summary) return summary.error();
  if (const CanLogSummary* const log = run.log_summary()) {
    tell_log_faults(arguments.source.name, *log);
    summary->can_rejected += log->broken_lines + log->stray_stamps;
  }
  failed.add(write_summary(*summary, arguments.json, arguments.events == "-"));
  failed.add(check_limits(*summary));
  return failed.all();
}

// The run, from what was read of it to its end.
Outcome<void> drive(const RunArguments& arguments, RunInputs& inputs,
                    std::vector<HandedFile>& handed, EndGuard& guard) {
  const std::string folder = state_folder(inputs.settings);
  const bool learns = inputs.settings.preload.learn;
  if (learns) {
    std::vector<std::string> notes;
    inputs.learned = go_on_learning(folder, inputs.learned, inputs.catalog.lineage, notes);
    for (const std::string& text : notes) warn(text);
  }
  MapTerms terms = map_terms(arguments, inputs);
  terms.lease_ns = static_cast<std::int64_t>(inputs.settings.serve.lease_s * 1e9);
  auto map = MapVersion::make(1, std::move(inputs.catalog), terms);
  if (!map) return map.error();
  const MapModel& model = (*map)->model();
  if (model.warning) warn(*model.warning);
  if (!terms.budget) {
    std::cerr << kProgram << ": memory.budget is not set: " << short_bytes(model.limits.budget)
              << " (" << counted(model.limits.budget, "byte") << ")"
              << (terms.max_signatures > 0 ? ", for the whole map" : ", the smallest for this map")
              << "; up to " << short_bytes(terms.default_most)
              << ", a quarter of the memory here, would be taken\n";
  }
  if (const auto claims = check_claims((*map)->catalog(), !terms.budget, ReadMode::kBuffered);
      !claims) {
    return claims.error();
  }

  const Notifier notifier = service_manager();
  const auto memory =
      LiveMemory::open({.zones = zones_with_room_for_another_map(model.needs.size()),
                        .slots = model.slots,
                        .socket = inputs.settings.serve.socket,
                        .may_wait = arguments.source.kind == CanSourceChoice::Kind::kSocketCan,
                        .manager = &notifier,
                        .handed = &handed});
  if (!memory) return memory.error();

  auto preface = make_preface(arguments, inputs, (*map)->catalog(), terms);
  if (!preface) return preface.error();
  LiveRun run(inputs, std::move(*map), **memory, notifier, guard,
              {.source = arguments.source,
               .start = arguments.start,
               .events = arguments.events,
               .record_can = arguments.record_can,
               .recording = {.file = arguments.record,
                             .state_folder = folder,
                             .flight_bytes = inputs.settings.recorder.bytes},
               .preface = std::move(*preface),
               .habits = learns ? std::make_unique<HabitKeeper>(folder, terms.learned) : nullptr,
               .build = {arguments.program, arguments.commit},
               .quiet = arguments.quiet,
               .allow_degraded = arguments.allow_degraded});
  if (const auto started = run.start(); !started) return started.error();
  run.wait();
  auto concluded = conclude(arguments, run);
  guard.waits_for("a thread that hangs in a call");
  return concluded;
}

Outcome<void> run_and_report(const RunArguments& arguments) {
  std::vector<HandedFile> handed = take_handed_files();
  if (arguments.source.kind == CanSourceChoice::Kind::kSocketCan &&
      (!arguments.corrections.empty() || !arguments.truth.empty())) {
    return usage_failure(
        "--corrections and --truth are on the time of a log, which socketcan: has not");
  }
  if (auto possible = check_run_outputs(arguments); !possible) return possible;
  hold_signals();
  use_one_heap(kHeapBytes);
  auto inputs = read_run_inputs(arguments);
  if (!inputs) return inputs.error();
  for (const std::string& text : inputs->warnings) warn(text);
  if (arguments.source.kind == CanSourceChoice::Kind::kLog &&
      (!inputs->corrections.empty() || inputs->truth)) {
    const LogTime time = LogTime::read(arguments.source.name, inputs->settings.can.interface);
    if (time.steps() && !arguments.corrections.empty()) {
      auto corrections = read_corrections_as_written(arguments.corrections);
      if (!corrections) return corrections.error();
      inputs->corrections = time.on_first_clock(std::move(*corrections));
    }
    if (inputs->truth) inputs->truth = time.on_first_clock(*inputs->truth);
  }
  ServeSettings& serve = inputs->settings.serve;
  serve.socket = listening_socket(arguments.socket, serve);
  EndGuard guard({serve.socket, inputs->settings.serve.looking_socket});
  return drive(arguments, *inputs, handed, guard);
}

}  // namespace

Outcome<void> check_run_outputs(const RunArguments& arguments) {
  return check_outputs({{"--events", arguments.events, true},
                        {"--json", arguments.json, true},
                        {"--record", arguments.record, false, Overwriting::kInPlace},
                        {"--record-can", arguments.record_can, false, Overwriting::kInPlace}});
}

int run_live(const RunArguments& arguments) {
  const auto done = run_and_report(arguments);
  return done ? 0 : report_failure(kProgram, done.error());
}

}  // namespace zonepack
