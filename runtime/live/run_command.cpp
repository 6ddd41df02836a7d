// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/run_command.hpp"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <utility>

#include "platform/clock.hpp"
#include "platform/realtime.hpp"
#include "platform/signals.hpp"
#include "platform/storage.hpp"
#include "runtime/live/live_memory.hpp"
#include "runtime/live/live_run.hpp"
#include "runtime/pack_format/file/manifest_file.hpp"
#include "runtime/run/log_faults.hpp"
#include "runtime/run/summary_text.hpp"

namespace zonepack {
namespace {

constexpr std::size_t kHeapBytes = 2 << 20;  // what a run takes at least, whatever the map

int fail_run(const std::string& message, int exit_code = 1) {
  std::cerr << "zoned run: " << message << '\n';
  return exit_code;
}

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

// What a recording says before its first cycle. A complete message for what is wrong, or nothing.
std::optional<std::string> make_preface(const RunArguments& arguments, const RunInputs& inputs,
                                        const Catalog& catalog, const MapTerms& terms,
                                        RecordingPreface& preface) {
  preface.program = arguments.program;
  preface.realtime_ns = realtime_ns();
  preface.settings_path = arguments.config;
  preface.settings = inputs.settings_text;
  preface.dbc = inputs.settings.can.dbc_text;
  preface.map_folder = catalog.folder;
  preface.terms = terms;
  const std::string path = catalog.folder + "/" + std::string(kManifestName);
  auto manifest = read_file(path, kMaxManifestFileBytes);
  if (!manifest || manifest_digest(*manifest) != catalog.version) {
    return path + ": changed while zoned was starting; start it again";
  }
  preface.manifest = std::move(manifest).value();
  return std::nullopt;
}

}  // namespace

int run_live(const RunArguments& arguments) {
  if (arguments.start.kind == StartChoice::Kind::kTruth && arguments.truth.empty()) {
    return fail_run("--start truth needs --truth FILE", 2);
  }
  std::vector<HandedFile> handed = take_handed_files();
  if (arguments.source.kind == CanSourceChoice::Kind::kSocketCan &&
      (!arguments.corrections.empty() || !arguments.truth.empty())) {
    return fail_run("--corrections and --truth are on the time of a log, which socketcan: has not",
                    2);
  }
  hold_signals();
  use_one_heap(kHeapBytes);
  RunInputs inputs;
  if (const auto fault = read_run_inputs(arguments, inputs)) return fail_run(*fault);
  std::string fault;
  MapTerms terms = map_terms(arguments, inputs.settings);
  terms.lease_ns = static_cast<std::int64_t>(inputs.settings.serve.lease_s * 1e9);
  auto map = MapVersion::make(1, std::move(inputs.catalog), terms, fault);
  if (!map) return fail_run(fault);
  const MapModel& model = map->model();
  if (model.warning) std::cerr << "zoned run: warning: " << *model.warning << '\n';

  auto manager = Notifier::from_environment();
  if (!manager) std::cerr << "zoned run: NOTIFY_SOCKET: cannot be reached; nobody is told\n";
  const Notifier notifier = manager ? std::move(*manager) : Notifier();
  std::string warning;
  const auto memory = LiveMemory::open(
      {zones_with_room_for_another_map(model.needs.size()), model.slots,
       socket_path(inputs.settings.serve),
       arguments.source.kind == CanSourceChoice::Kind::kSocketCan, &notifier, &handed},
      fault, warning);
  if (!memory) return fail_run(fault);
  if (!warning.empty()) std::cerr << "zoned run: warning: " << warning << '\n';

  LiveOptions options{
      arguments.source,        arguments.start, arguments.events, arguments.record_can, {}, {},
      arguments.allow_degraded};
  options.recorder = {arguments.record, state_folder(inputs.settings),
                      inputs.settings.recorder.bytes};
  if (const auto bad = make_preface(arguments, inputs, map->catalog(), terms, options.preface)) {
    return fail_run(*bad);
  }
  LiveRun run(inputs, std::move(map), *memory, notifier, options);
  if (!run.start(fault)) return fail_run(fault);
  run.wait();
  auto summary = run.finish(fault);
  if (!summary) return fail_run(fault);
  if (const CanLogSummary* const log = run.log_summary()) {
    tell_log_faults(arguments.source.name, *log);
    summary->can_rejected += log->broken_lines + log->stray_stamps;
  }
  if (auto unwritten = write_summary(*summary, arguments.json)) return fail_run(*unwritten);
  if (summary->budget_violations > 0) {
    return fail_run("a limit was exceeded in " + std::to_string(summary->budget_violations) +
                    " cycles");
  }
  return 0;
}

}  // namespace zonepack
