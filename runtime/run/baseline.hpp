// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

// What RTAB-Map itself did on the same recording, to draw beside ours: one row for each image that
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

// Fills `rows`. Returns nothing when read, else a complete message for the user.
std::optional<std::string> read_baseline(const std::string& path, std::vector<BaselineRow>& rows);

}  // namespace zonepack
