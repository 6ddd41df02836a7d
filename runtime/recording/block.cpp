// SPDX-License-Identifier: Apache-2.0
#include "runtime/recording/block.hpp"

#include <lz4.h>

#include <algorithm>
#include <cstring>

#include "platform/base/require.hpp"

namespace zonepack {
namespace {

constexpr std::size_t kChecksumBytes = 8;
constexpr std::uint8_t kRaw = 0, kLz4 = 1;

const char* chars(const std::byte* bytes) noexcept { return reinterpret_cast<const char*>(bytes); }
char* chars(std::byte* bytes) noexcept { return reinterpret_cast<char*>(bytes); }

}  // namespace

std::vector<std::byte> recording_header() {
  std::vector<std::byte> bytes(kRecordingHeaderBytes);
  ByteWriter out(bytes);
  for (const std::uint8_t byte : kRecordingMagic) out.u8(byte);
  out.u16(kRecordingMajor);
  out.u16(kRecordingMinor);
  out.u32(0);
  return bytes;
}

Result<void> check_recording_header(ByteSpan bytes) noexcept {
  ByteReader in(bytes);
  for (const std::uint8_t byte : kRecordingMagic) {
    if (in.u8() != byte) return ErrorCode::kBadMagic;
  }
  const std::uint16_t major = in.u16();
  in.u16();
  in.u32();
  if (!in.ok()) return {ErrorCode::kTruncated, static_cast<std::int64_t>(bytes.size())};
  if (major != kRecordingMajor) return {ErrorCode::kBadVersion, major};
  return {};
}

void seal_block(BlockKind kind, ByteSpan content, std::vector<std::byte>& into) {
  ZP_REQUIRE(!content.empty() && content.size() <= kMostBlockBytes);
  const int bound = LZ4_compressBound(static_cast<int>(content.size()));
  into.resize(kBlockHeaderBytes + static_cast<std::size_t>(bound));
  std::byte* const stored = into.data() + kBlockHeaderBytes;
  auto size = static_cast<std::size_t>(LZ4_compress_default(
      chars(content.data()), chars(stored), static_cast<int>(content.size()), bound));
  std::uint8_t codec = kLz4;
  if (size == 0 || size >= content.size()) {
    codec = kRaw;
    size = content.size();
    std::memcpy(stored, content.data(), size);
  }
  into.resize(kBlockHeaderBytes + size);
  ByteWriter out(into);
  out.u64(0);
  out.u32(static_cast<std::uint32_t>(size));
  out.u32(static_cast<std::uint32_t>(content.size()));
  out.u8(static_cast<std::uint8_t>(kind));
  out.u8(codec);
  out.u16(0);
  const std::uint64_t checksum = xxh3(ByteSpan(into).subspan(kChecksumBytes));
  ByteWriter(into).u64(checksum);
}

Result<RecordingBlockHeader> read_block_header(ByteSpan header) noexcept {
  ByteReader in(header);
  RecordingBlockHeader block;
  block.checksum = in.u64();
  block.stored_size = in.u32();
  block.decoded_size = in.u32();
  block.kind = in.u8();
  block.codec = in.u8();
  in.u16();
  if (!in.ok()) return {ErrorCode::kTruncated, static_cast<std::int64_t>(header.size())};
  if (block.decoded_size == 0 || block.decoded_size > kMostBlockBytes ||
      block.stored_size > block.decoded_size) {
    return {ErrorCode::kTooLarge, block.decoded_size};
  }
  return block;
}

Result<void> open_block(ByteSpan block, std::vector<std::byte>& into) {
  const Result<RecordingBlockHeader> header = read_block_header(block);
  if (!header) return header.error();
  const ByteSpan stored = block.subspan(kBlockHeaderBytes);
  if (stored.size() != header->stored_size) return ErrorCode::kTruncated;
  if (xxh3(block.subspan(kChecksumBytes)) != header->checksum) return ErrorCode::kBadChecksum;
  into.resize(header->decoded_size);
  if (header->codec == kRaw) {
    if (stored.size() != into.size()) return ErrorCode::kBadCompression;
    std::memcpy(into.data(), stored.data(), stored.size());
    return {};
  }
  if (header->codec != kLz4) return {ErrorCode::kBadVersion, header->codec};
  const int decoded =
      LZ4_decompress_safe(chars(stored.data()), chars(into.data()), static_cast<int>(stored.size()),
                          static_cast<int>(into.size()));
  if (decoded < 0 || static_cast<std::size_t>(decoded) != into.size()) {
    return ErrorCode::kBadCompression;
  }
  return {};
}

}  // namespace zonepack
