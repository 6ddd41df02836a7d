// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "runtime/report/report.hpp"
#include "runtime/run/figures/baseline.hpp"
#include "runtime/run/figures/run_summary.hpp"
#include "runtime/run/figures/run_trace.hpp"

namespace zonepack {

// A replay as a report. Over time: signatures loaded and unloaded, signatures and bytes in memory
// against their limits, the error of the pose; from above: the route coloured by zone. With a
// baseline, RTAB-Map's own curves next to ours; with truth, the true route and the error.
struct RunReportInput {
  std::string map;  // as given by the user
  std::string recording;
  const RunSummary& summary;
  const RunTrace& trace;
  const std::vector<BaselineRow>& baseline;  // empty: none
};

report::Report make_run_report(const RunReportInput& input);

// The same run in one small picture, for a page of one's own: the route, the loading curves, the
// bytes against the budget.
report::Report make_run_picture(const RunReportInput& input);

}  // namespace zonepack
