// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "runtime/evaluate/evaluation.hpp"
#include "runtime/report/report.hpp"

namespace zonepack {

// What was compared, as a page: signatures loaded over the budget for each policy, with the bounds;
// for each drive the curves of the paper (retrieved, removed, in working memory over time) for each
// map and policy, with RTAB-Map's next to them; and the totals as a table.
report::Report make_evaluation_report(const Evaluation& evaluation,
                                      const std::vector<Choice>& choices,
                                      const std::vector<Evaluated>& results);

}  // namespace zonepack
