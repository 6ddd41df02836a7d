// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "platform/base/failure.hpp"
#include "runtime/evaluate/evaluate_command.hpp"
#include "runtime/evaluate/evaluation.hpp"

namespace zonepack {

// From the smallest budget of a map with these pins to the whole map: at most eight, in equal
// steps, each a whole number of slots.
std::vector<ByteCount> auto_budgets(const Catalog& catalog, const std::vector<ZoneId>& pinned);

// Every combination: by map, drive, budget, limit of signatures, eviction, preloading and storage
// rate, the last changing first. What is not given is as in the settings; budgets are `auto` where
// the settings have none and nothing limits signatures. Fails, before anything is run, when a map
// cannot be held on one of the terms.
Outcome<std::vector<Choice>> choices_of(const EvaluateArguments& arguments,
                                        const Evaluation& evaluation);

}  // namespace zonepack
