// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "platform/base/failure.hpp"

// What RTAB-Map itself did on the same recording, to draw next to ours: one row for each image that
// it processed. A CSV file with a line of column names (t, wm, cum_removed and cum_retrieved are
// read, in any order) and comments from '#' on. RTAB-Map's `removed` counts the query images too,
// one a row, so that map signatures unloaded = cumulative removed - rows.
namespace zonepack {

struct BaselineRow {
  double t_s = 0;        // since the first row
  double in_memory = 0;  // signatures in working memory
  double loaded = 0;     // cumulative
  double unloaded = 0;   // cumulative, map signatures only
};

Outcome<std::vector<BaselineRow>> read_baseline(const std::string& path);

}  // namespace zonepack
