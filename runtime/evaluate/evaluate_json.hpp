// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "runtime/evaluate/evaluation.hpp"

namespace zonepack {

// The results of all choices, in their order: an object with a list `runs`, whose keys README of
// runtime names.
std::string evaluation_json(const Evaluation& evaluation, const std::vector<Choice>& choices,
                            const std::vector<Evaluated>& results);

// The same in short, for people, a line each.
std::string evaluation_table(const Evaluation& evaluation, const std::vector<Choice>& choices,
                             const std::vector<Evaluated>& results);

// The name of a run's file in the folder of --trace-csv.
std::string trace_file_name(std::size_t run);

}  // namespace zonepack
