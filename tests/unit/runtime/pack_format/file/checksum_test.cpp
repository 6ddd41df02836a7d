// SPDX-License-Identifier: Apache-2.0
// The checksum with the widest instructions of this processor (AVX2 or AVX-512 chosen at run time,
// NEON at compile time) against the same algorithm without any.
#include "runtime/pack_format/file/checksum.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#define XXH_INLINE_ALL
#define XXH_VECTOR 0  // XXH_SCALAR
#include <xxhash.h>

namespace zonepack {
namespace {

TEST(Checksum, IsTheSameWithAndWithoutVectorInstructions) {
  std::vector<std::byte> bytes(70'000);
  std::uint64_t state = 1;
  for (std::byte& byte : bytes) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    byte = static_cast<std::byte>(state >> 56);
  }
  const auto same = [&](std::size_t at, std::size_t size) {
    const ByteSpan span = std::span(bytes).subspan(at, size);
    EXPECT_EQ(xxh3(span), XXH3_64bits(span.data(), span.size())) << size << " bytes at " << at;
  };
  for (std::size_t size = 0; size <= 2100; ++size) same(size % 7, size);  // over two stripe blocks
  for (const std::size_t size : {4096u, 16'384u, 16'385u, 65'536u, 69'937u}) {
    for (std::size_t at = 0; at < 64; at += 9) same(at, size - (at + size > 70'000 ? at : 0));
  }
}

}  // namespace
}  // namespace zonepack
