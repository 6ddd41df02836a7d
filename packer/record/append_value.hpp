// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <type_traits>

#include "packer/record/record.hpp"

namespace zonepack::packer {

// Appends a number, an enumerator or a plain structure as it lies in memory: little endian, as the
// formats are and the machines that pack.
template <typename T>
void append_value(Bytes& out, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  const auto bytes = std::as_bytes(std::span(&value, 1));
  out.insert(out.end(), bytes.begin(), bytes.end());
}

}  // namespace zonepack::packer
