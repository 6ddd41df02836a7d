// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace zonepack::localize {

// Bits in which two descriptors of `bytes` bytes differ. Any length.
std::uint32_t hamming_plain(const std::uint8_t* a, const std::uint8_t* b,
                            std::size_t bytes) noexcept;

// out[i] = bits in which `one` and row i of `rows` differ, for `count` rows back to back. At most
// 65535 bits. Nothing needs to be aligned.
void hamming_rows_plain(const std::uint8_t* one, const std::uint8_t* rows, std::size_t count,
                        std::size_t bytes, std::uint16_t* out) noexcept;

// The same with what this processor has: AVX2, found when the program runs, or NEON. Equal bit by
// bit; the plain one where there is neither, and for lengths that are not a multiple of 32.
void hamming_rows(const std::uint8_t* one, const std::uint8_t* rows, std::size_t count,
                  std::size_t bytes, std::uint16_t* out) noexcept;

// "avx2", "neon" or "plain": what hamming_rows() uses here.
std::string_view hamming_kind() noexcept;

}  // namespace zonepack::localize
