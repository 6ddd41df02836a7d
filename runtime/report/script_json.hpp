// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// JSON for a <script> element of a page: compact, and nothing in it can end the element.
namespace zonepack::report {

// A text with its quotes. < > & are escaped, and bytes that are not UTF-8 replaced by U+FFFD.
std::string script_string(std::string_view text);
std::string script_strings(std::span<const std::string> texts);

// "[12,3,-1]": value * per_unit, rounded, each but the first as the difference from the one before;
// null where a value is not finite, which the next difference passes over.
std::string script_differences(std::span<const double> values, double per_unit);

// The numbers as they are.
std::string script_numbers(std::span<const std::int64_t> values);

}  // namespace zonepack::report
