// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <flatbuffers/flatbuffers.h>

#include <cstdint>

// FlatBuffers' verifier does not check the alignment of structs; a processor that requires aligned
// 64-bit values would stop at the first misaligned one.
namespace zonepack {

template <typename Struct>
bool is_aligned(const Struct* value) noexcept {
  return reinterpret_cast<std::uintptr_t>(value) % alignof(Struct) == 0;
}

template <typename Struct>
bool is_aligned(const flatbuffers::Vector<const Struct*>* vector) noexcept {
  return vector == nullptr || vector->size() == 0 ||
         reinterpret_cast<std::uintptr_t>(vector->Data()) % alignof(Struct) == 0;
}

}  // namespace zonepack
