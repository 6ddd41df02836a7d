// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/replay/beside_run.hpp"

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "runtime/run/figures/csv_columns.hpp"
#include "runtime/run/inputs/run_files.hpp"

namespace zonepack::localize {
namespace {

enum Column : std::size_t { kTime, kAccepted, kX, kY, kYaw, kColumns };
constexpr std::array<std::string_view, kColumns> kNames = {"t", "accepted", "mx", "my", "myaw"};

// Whether the first line that is no comment names columns of a CSV file of ours.
bool is_csv(const std::string& path) {
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line == "\r" || line.front() == '#') continue;
    return line.find(',') != std::string::npos &&
           (line.find("accepted") != std::string::npos || line.find("mx") != std::string::npos);
  }
  return false;
}

Outcome<BesideRun> read_csv(const std::string& path) {
  BesideRun run;
  run.name = "RTAB-Map";
  const auto take = [&run](std::span<const double> row) -> Outcome<void> {
    ++run.images;
    if (row[kAccepted] == 0) return {};
    if (!(std::abs(row[kTime]) < 9e9)) return failure("column t: not seconds since 1970");
    run.fixes.push_back({std::llround(row[kTime] * 1e9), {row[kX], row[kY], row[kYaw]}});
    return {};
  };
  if (const auto read = read_csv_columns(path, "the other localizer's run", kNames, take); !read) {
    return read.error();
  }
  return run;
}

}  // namespace

Outcome<BesideRun> read_beside(const std::string& path) {
  if (is_csv(path)) return read_csv(path);
  const auto poses = read_truth(path);
  if (!poses) {
    return failure(
        poses.error().message + ". Or give a CSV file with the columns t, accepted, mx, my, myaw",
        poses.error().code);
  }
  BesideRun run;
  run.name = std::filesystem::path(path).filename().string();
  for (const TruthTrack::Sample& sample : poses->samples()) {
    run.fixes.push_back({sample.t_ns, sample.T_map_base});
  }
  return run;
}

}  // namespace zonepack::localize
