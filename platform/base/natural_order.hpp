// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace zonepack {

// Whether `a` comes before `b` for a reader: runs of digits compare as numbers, so "room2" comes
// before "room10" and "hall.9" before "hall.10"; all else compares by bytes. Texts that differ only
// in leading zeros compare by bytes, so that the order is total.
bool natural_less(std::string_view a, std::string_view b) noexcept;

}  // namespace zonepack
