// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/figures/baseline.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "runtime/run/figures/csv_columns.hpp"

namespace zonepack {
namespace {

enum Column : std::size_t { kTime, kWorkingMemory, kRemoved, kRetrieved, kColumns };
constexpr std::array<std::string_view, kColumns> kNames = {"t", "wm", "cum_removed",
                                                           "cum_retrieved"};

}  // namespace

Outcome<std::vector<BaselineRow>> read_baseline(const std::string& path) {
  std::vector<BaselineRow> rows;
  double first_t_s = 0;
  const auto take = [&](std::span<const double> values) -> Outcome<void> {
    if (rows.empty()) first_t_s = values[kTime];
    const double t_s = values[kTime] - first_t_s;
    if (!rows.empty() && t_s < rows.back().t_s) return failure("time goes back");
    const auto count = static_cast<double>(rows.size() + 1);
    rows.push_back({.t_s = t_s,
                    .in_memory = values[kWorkingMemory],
                    .loaded = values[kRetrieved],
                    .unloaded = std::max(0.0, values[kRemoved] - count)});
    return {};
  };
  if (const auto read = read_csv_columns(path, "the baseline", kNames, take); !read) {
    return read.error();
  }
  return rows;
}

}  // namespace zonepack
