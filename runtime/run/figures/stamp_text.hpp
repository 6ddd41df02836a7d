// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

// Numbers and stamps in text files that come with a recorded run. The whole word must be one; false
// else.
namespace zonepack {

bool parse_number(std::string_view word, double& value);

// Seconds as nanoseconds, exact for plain decimals; to a double's precision with an exponent. 18
// digits or more without a point are whole nanoseconds.
bool parse_stamp(std::string_view word, std::int64_t& stamp_ns);

}  // namespace zonepack
