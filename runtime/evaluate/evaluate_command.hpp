// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "platform/base/byte_count.hpp"
#include "platform/base/failure.hpp"
#include "runtime/evaluate/drives.hpp"

namespace zonepack {

struct EvaluateArguments {
  std::string config;
  std::vector<std::string> maps;
  std::vector<DriveFiles> drives;
  std::vector<ByteCount> budgets;  // empty: see auto_budgets
  bool auto_budgets = false;
  std::vector<std::uint64_t> max_signatures;
  std::vector<std::string> evictions, preloads;
  std::vector<std::uint64_t> storage_rates;
  unsigned jobs = 0;  // 0: one a core
  std::string json, report, trace_csv;
};

// "auto", or sizes with commas between; false for another text.
bool parse_budgets(std::string_view text, EvaluateArguments& arguments);

// Names with commas between, each of which `known` has. The message names the first other one, and
// those that may be meant.
Outcome<std::vector<std::string>> parse_names(std::string_view text,
                                              const std::vector<std::string>& known);
std::vector<std::string> eviction_names();
std::vector<std::string> preload_names();

// Replays every drive on every map with every combination of the other choices, and writes results;
// the table goes to standard output, messages and progress to standard error. Returns the exit
// code: 0, or 1 when something could not be read, held or written, or a limit was exceeded.
int run_evaluate(const EvaluateArguments& arguments);

}  // namespace zonepack
