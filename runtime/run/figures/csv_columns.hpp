// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "platform/base/failure.hpp"

namespace zonepack {

// Reads some columns of a CSV file: a line of column names, then numbers. The columns stand in any
// order among others; empty lines, lines that begin with # and CR are passed over. `row` gets the
// numbers in the order of `names`; what it returns is reported with the file and the line. `what`
// names the file in messages: "the baseline".
Outcome<void> read_csv_columns(const std::string& path, const std::string& what,
                               std::span<const std::string_view> names,
                               const std::function<Outcome<void>(std::span<const double>)>& row);

}  // namespace zonepack
