// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/localize/replay/beside_run.hpp"
#include "runtime/localize/replay/camera_loop.hpp"
#include "runtime/localize/replay/loop_figures.hpp"
#include "runtime/report/report.hpp"
#include "runtime/run/inputs/run_files.hpp"
#include "runtime/run/run_report.hpp"

namespace zonepack::localize {

struct LoopReportInput {
  const RunReportInput& run;
  const CameraLoop& loop;
  const LoopFigures& figures;
  const TruthTrack* truth = nullptr;  // null: not known
  const BesideRun* beside = nullptr;  // on the clock of the cycles; null: none
};

// The report of the run (runtime/run/run_report.hpp), and from above: each fix where it was found,
// each image without one where the robot believed to be, by reason; the fixes of another localizer
// around ours; both counted and judged in a table.
report::Report make_loop_report(const LoopReportInput& input);

// The plan of the fixes alone, for a page of one's own.
report::Report make_loop_picture(const LoopReportInput& input);

}  // namespace zonepack::localize
