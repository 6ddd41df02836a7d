// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/features/hamming.hpp"

#include <bit>
#include <cstring>

#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__ARM_NEON)
#include <arm_neon.h>
#endif

namespace zonepack::localize {

std::uint32_t hamming_plain(const std::uint8_t* a, const std::uint8_t* b,
                            std::size_t bytes) noexcept {
  int bits = 0;
  std::size_t i = 0;
  for (; i + 8 <= bytes; i += 8) {
    std::uint64_t x = 0, y = 0;
    std::memcpy(&x, a + i, 8);
    std::memcpy(&y, b + i, 8);
    bits += std::popcount(x ^ y);
  }
  for (; i < bytes; ++i) bits += std::popcount(static_cast<unsigned>(a[i] ^ b[i]));
  return static_cast<std::uint32_t>(bits);
}

void hamming_rows_plain(const std::uint8_t* one, const std::uint8_t* rows, std::size_t count,
                        std::size_t bytes, std::uint16_t* out) noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = static_cast<std::uint16_t>(hamming_plain(one, rows + i * bytes, bytes));
  }
}

#if defined(__x86_64__)
namespace {

// Bits set in each 8 bytes of 32. Counts by looking up each nibble, then sums bytes: Mula, Kurz and
// Lemire, "Faster Population Counts Using AVX2 Instructions", 2018.
[[gnu::target("avx2")]] inline __m256i count_avx2(__m256i x) noexcept {
  const __m256i nibble = _mm256_set1_epi8(15);
  const __m256i bits = _mm256_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4, 0, 1, 1, 2,
                                        1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4);
  const __m256i low = _mm256_shuffle_epi8(bits, _mm256_and_si256(x, nibble));
  const __m256i high = _mm256_shuffle_epi8(bits, _mm256_and_si256(_mm256_srli_epi16(x, 4), nibble));
  return _mm256_sad_epu8(_mm256_add_epi8(low, high), _mm256_setzero_si256());
}

[[gnu::target("avx2")]] inline __m256i differing_avx2(const std::uint8_t* a, const std::uint8_t* b,
                                                      std::size_t bytes) noexcept {
  __m256i sum = _mm256_setzero_si256();
  for (std::size_t k = 0; k < bytes; k += 32) {
    const __m256i one = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(a + k));
    const __m256i other = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(b + k));
    sum = _mm256_add_epi64(sum, count_avx2(_mm256_xor_si256(one, other)));
  }
  return sum;
}

// Four rows share what it takes to add up the parts of each. kBytes: of a row, where it is known.
template <std::size_t kBytes = 0>
[[gnu::target("avx2")]] void hamming_rows_avx2(const std::uint8_t* one, const std::uint8_t* rows,
                                               std::size_t count, std::size_t any_bytes,
                                               std::uint16_t* out) noexcept {
  const std::size_t bytes = kBytes > 0 ? kBytes : any_bytes;
  const __m256i ones = _mm256_set1_epi16(1);
  std::size_t i = 0;
  for (; i + 4 <= count; i += 4, rows += 4 * bytes) {
    const __m256i first = _mm256_packs_epi32(differing_avx2(one, rows, bytes),
                                             differing_avx2(one, rows + bytes, bytes));
    const __m256i second = _mm256_packs_epi32(differing_avx2(one, rows + 2 * bytes, bytes),
                                              differing_avx2(one, rows + 3 * bytes, bytes));
    const __m256i pairs = _mm256_madd_epi16(_mm256_packs_epi32(first, second), ones);
    const __m128i four =
        _mm_add_epi32(_mm256_castsi256_si128(pairs), _mm256_extracti128_si256(pairs, 1));
    _mm_storel_epi64(reinterpret_cast<__m128i*>(out + i), _mm_packus_epi32(four, four));
  }
  for (; i < count; ++i, rows += bytes) {
    const __m256i sum = differing_avx2(one, rows, bytes);
    const __m128i half =
        _mm_add_epi64(_mm256_castsi256_si128(sum), _mm256_extracti128_si256(sum, 1));
    out[i] = static_cast<std::uint16_t>(_mm_extract_epi16(half, 0) + _mm_extract_epi16(half, 4));
  }
}

const bool kAvx2 = __builtin_cpu_supports("avx2") != 0;

}  // namespace
#elif defined(__ARM_NEON)
namespace {

void hamming_rows_neon(const std::uint8_t* one, const std::uint8_t* rows, std::size_t count,
                       std::size_t bytes, std::uint16_t* out) noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    uint16x8_t sum = vdupq_n_u16(0);
    for (std::size_t k = 0; k < bytes; k += 16) {
      const uint8x16_t x = veorq_u8(vld1q_u8(one + k), vld1q_u8(rows + i * bytes + k));
      sum = vpadalq_u8(sum, vcntq_u8(x));
    }
    const uint64x2_t total = vpaddlq_u32(vpaddlq_u16(sum));
    out[i] = static_cast<std::uint16_t>(vgetq_lane_u64(total, 0) + vgetq_lane_u64(total, 1));
  }
}

}  // namespace
#endif

void hamming_rows(const std::uint8_t* one, const std::uint8_t* rows, std::size_t count,
                  std::size_t bytes, std::uint16_t* out) noexcept {
#if defined(__x86_64__)
  if (kAvx2 && bytes == 32) return hamming_rows_avx2<32>(one, rows, count, bytes, out);
  if (kAvx2 && bytes % 32 == 0) return hamming_rows_avx2(one, rows, count, bytes, out);
#elif defined(__ARM_NEON)
  if (bytes % 32 == 0) return hamming_rows_neon(one, rows, count, bytes, out);
#endif
  hamming_rows_plain(one, rows, count, bytes, out);
}

std::string_view hamming_kind() noexcept {
#if defined(__x86_64__)
  return kAvx2 ? "avx2" : "plain";
#elif defined(__ARM_NEON)
  return "neon";
#else
  return "plain";
#endif
}

}  // namespace zonepack::localize
