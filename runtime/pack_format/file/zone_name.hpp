// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

// What a name may hold. Names become file names, lines of logs, JSON and text on a terminal.
namespace zonepack {

// UTF-8 without control characters (C0, DEL, C1): what every text of a manifest must be.
bool is_plain_text(std::string_view text) noexcept;

// Why the text cannot be the name of a zone: it is not plain, too short or too long, begins with a
// dot, begins or ends with a blank, or holds / \ or ". The same rule for packer, verify and robot.
enum class NameFault { kEmpty, kTooLong, kDot, kBlank, kSeparator, kNotPlain };
std::optional<NameFault> name_fault(std::string_view name) noexcept;

}  // namespace zonepack
