// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "platform/base/require.hpp"
#include "runtime/pack_format/file/byte_codec.hpp"
#include "runtime/pack_format/file/checksum.hpp"

// What small files of numbers begin with: 8 bytes that name the format, u16 major and minor
// version, u32 size of the content, u64 its XXH3.
namespace zonepack {

inline constexpr std::size_t kSmallFileHeaderBytes = 24;

// Completes a file whose content was written behind the header's room: fills that in and cuts what
// was not written.
inline void complete_small_file(std::vector<std::byte>& file,
                                std::span<const std::uint8_t, 8> magic, std::uint16_t major,
                                std::uint16_t minor, const ByteWriter& content) {
  ZP_REQUIRE(content.ok());
  ByteWriter header(file);
  for (const std::uint8_t byte : magic) header.u8(byte);
  header.u16(major);
  header.u16(minor);
  header.u32(static_cast<std::uint32_t>(content.size()));
  header.u64(xxh3(content.written()));
  file.resize(kSmallFileHeaderBytes + content.size());
}

// Leaves the digest as it is where the bytes end before it, as in.ok() then says.
template <typename Digest>
void read_digest(ByteReader& in, Digest& digest) {
  const ByteSpan bytes = in.bytes(digest.size());
  if (!bytes.empty()) std::memcpy(digest.data(), bytes.data(), digest.size());
}

}  // namespace zonepack
