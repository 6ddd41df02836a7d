// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "platform/base/result.hpp"
#include "runtime/recording/bytes.hpp"

// The frame of a recording: a file header, then blocks, each checked and compressed by itself
// (RECORDING.md).
namespace zonepack {

inline constexpr std::uint8_t kRecordingMagic[8] = {0x89, 'Z', 'P', 'R', '\r', '\n', 0x1A, '\n'};
inline constexpr std::uint16_t kRecordingMajor = 1;
inline constexpr std::uint16_t kRecordingMinor = 1;
inline constexpr std::size_t kRecordingHeaderBytes = 16;

enum class BlockKind : std::uint8_t {
  kPreface = 1,
  kCycles = 2,
  kCheckpoint = 3,
  kEnd = 4,
  kMap = 5,
};
// A reader may skip unknown blocks of this kind and above.
inline constexpr std::uint8_t kFirstNoteBlock = 128;

inline constexpr std::size_t kBlockHeaderBytes = 20;
inline constexpr std::size_t kMostBlockBytes = std::size_t{1024} * 1024;  // decoded

struct RecordingBlockHeader {
  std::uint64_t checksum = 0;  // XXH3 of the header's other bytes and the stored ones
  std::uint32_t stored_size = 0;
  std::uint32_t decoded_size = 0;
  std::uint8_t kind = 0;
  std::uint8_t codec = 0;  // 0: as it is, 1: an LZ4 block
};

// The first bytes of a recording.
std::vector<std::byte> recording_header();
// kBadMagic, kBadVersion.
Result<void> check_recording_header(ByteSpan bytes) noexcept;

// Makes a whole block from a content of 1 to kMostBlockBytes; replaces `into`.
void seal_block(BlockKind kind, ByteSpan content, std::vector<std::byte>& into);

// Sizes within limits (kTooLarge), so that the stored bytes may be read.
Result<RecordingBlockHeader> read_block_header(ByteSpan header) noexcept;

// Extracts the content of a whole block, header included; replaces `into`. kBadChecksum,
// kBadCompression, kBadVersion for another codec.
Result<void> open_block(ByteSpan block, std::vector<std::byte>& into);

}  // namespace zonepack
