// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/run_command.hpp"

#include <iostream>

#include "platform/atomic_file.hpp"
#include "platform/realtime.hpp"
#include "platform/signals.hpp"
#include "runtime/live/live_run.hpp"
#include "runtime/replay/log_faults.hpp"
#include "runtime/replay/summary_text.hpp"

namespace zonepack {
namespace {

int fail(const std::string& message, int exit_code = 1) {
  std::cerr << "zoned run: " << message << '\n';
  return exit_code;
}

}  // namespace

int run_live(const RunArguments& arguments) {
  if (arguments.start.kind == StartChoice::Kind::kTruth && arguments.truth.empty()) {
    return fail("--start truth needs --truth FILE", 2);
  }
  hold_signals();
  use_one_heap();
  RunInputs inputs;
  if (const auto fault = read_run_inputs(arguments, inputs)) return fail(*fault);
  std::string fault;
  MapTerms terms = map_terms(arguments, inputs.settings);
  terms.lease_ns = static_cast<std::int64_t>(inputs.settings.memory.lease_s * 1e9);
  const auto map = DrivenMap::make(inputs.catalog, terms, fault);
  if (!map) return fail(fault);
  if (map->warning) std::cerr << "zoned run: warning: " << *map->warning << '\n';

  LiveRun run(inputs, *map,
              {arguments.source, arguments.start, arguments.events, arguments.allow_degraded});
  if (!run.start(fault)) return fail(fault);
  run.wait();
  auto summary = run.finish(fault);
  if (!summary) return fail(fault);
  if (const CanLogSummary* const log = run.log_summary()) {
    tell_log_faults(arguments.source.name, *log);
    summary->can_rejected += log->broken_lines + log->stray_stamps;
  }
  if (auto unwritten = write_summary(*summary, arguments.json)) return fail(*unwritten);
  if (summary->budget_violations > 0) {
    return fail("a limit was exceeded in " + std::to_string(summary->budget_violations) +
                " cycles");
  }
  return 0;
}

}  // namespace zonepack
