// SPDX-License-Identifier: Apache-2.0
#include "runtime/pack_format/file/pack_file.hpp"

#include <lz4.h>

#include <cstddef>
#include <cstring>

#include "runtime/pack_format/file/zone_name.hpp"
#include "runtime/pack_format/struct_alignment.hpp"

namespace zonepack {
namespace {

ByteSpan bytes_of(const PackHeader& header) noexcept {
  return std::as_bytes(std::span(&header, 1));
}

// The tail without its digest and magic.
ByteSpan checked_part(const PackTail& tail) noexcept {
  return std::as_bytes(std::span(&tail, 1)).first(offsetof(PackTail, digest));
}

bool entry_is_sound(const fb::ChunkEntry& entry, std::uint32_t signatures) noexcept {
  const bool size_is_sound = entry.codec() == fb::ChunkCodec::Raw
                                 ? entry.stored_size() == entry.decoded_size()
                                 : entry.codec() == fb::ChunkCodec::Lz4;
  constexpr auto kKindBits = static_cast<fb::PayloadKind>(32);  // kinds that a mask can name
  return size_is_sound && entry.kind() < kKindBits && entry.decoded_size() > 0 &&
         entry.stored_size() > 0 && entry.first_signature() <= entry.last_signature() &&
         entry.last_signature() < signatures && entry.reserved() == 0 && entry.reserved2() == 0;
}

}  // namespace

Digest32 pack_digest(const PackHeader& header, ByteSpan index, const PackTail& tail) noexcept {
  return blake2b_32({bytes_of(header), index, checked_part(tail)});
}

Result<PackTail> check_tail(ByteSpan last_64_bytes, std::uint64_t file_size) noexcept {
  constexpr std::uint64_t kFrame = sizeof(PackHeader) + sizeof(PackTail);
  if (file_size < kFrame || last_64_bytes.size() != sizeof(PackTail)) {
    return {ErrorCode::kTruncated, static_cast<std::int64_t>(file_size)};
  }
  PackTail tail;
  std::memcpy(&tail, last_64_bytes.data(), sizeof tail);
  if (tail.magic != kPackEndMagic) return ErrorCode::kBadMagic;
  if (tail.major != kPackMajor) return {ErrorCode::kBadVersion, tail.major};
  const std::uint64_t room = file_size - sizeof(PackTail);
  if (tail.index_offset < sizeof(PackHeader) || tail.index_offset > room ||
      tail.index_size != room - tail.index_offset) {
    return {ErrorCode::kTruncated, static_cast<std::int64_t>(tail.index_offset)};
  }
  if (is_over(LimitId::kIndexBytes, tail.index_size)) {
    return over_limit(LimitId::kIndexBytes, tail.index_size);
  }
  return tail;
}

Result<const fb::PackIndex*> check_index(ByteSpan header_16_bytes, ByteSpan index,
                                         const PackTail& tail) noexcept {
  PackHeader header;
  if (header_16_bytes.size() != sizeof header || index.size() != tail.index_size) {
    return ErrorCode::kTruncated;
  }
  std::memcpy(&header, header_16_bytes.data(), sizeof header);
  if (header.magic != kPackMagic) return ErrorCode::kBadMagic;
  if (header.major != kPackMajor) return {ErrorCode::kBadVersion, header.major};
  if (pack_digest(header, index, tail) != tail.digest) {
    return {ErrorCode::kBadChecksum, static_cast<std::int64_t>(tail.index_offset)};
  }
  flatbuffers::Verifier verifier(reinterpret_cast<const std::uint8_t*>(index.data()), index.size(),
                                 2, 8);
  if (!verifier.VerifyBuffer<fb::PackIndex>()) return ErrorCode::kBadStructure;
  const auto* const root = flatbuffers::GetRoot<fb::PackIndex>(index.data());
  if (!is_aligned(root->chunks())) return ErrorCode::kBadStructure;
  if (root->slot_bytes() != kSlotBytes) return {ErrorCode::kMismatch, root->slot_bytes()};
  const std::pair<LimitId, std::uint64_t> measures[] = {
      {LimitId::kChunksOfPack, root->chunks()->size()},
      {LimitId::kSignaturesOfZone, root->signatures()},
      {LimitId::kNameBytes, root->zone()->size()}};
  for (const auto& [id, found] : measures) {
    if (is_over(id, found)) return over_limit(id, found);
  }
  if (name_fault(root->zone()->string_view())) return ErrorCode::kBadValue;
  if (index.size() > most_index_bytes(root->chunks()->size())) {
    return {ErrorCode::kTooLarge, static_cast<std::int64_t>(index.size())};
  }
  std::uint64_t end = sizeof(PackHeader);
  for (const fb::ChunkEntry* entry : *root->chunks()) {
    if (is_over(LimitId::kDecodedBytes, entry->decoded_size())) {
      return over_limit(LimitId::kDecodedBytes, entry->decoded_size());
    }
    if (is_over(LimitId::kStoredBytes, entry->stored_size())) {
      return over_limit(LimitId::kStoredBytes, entry->stored_size());
    }
    if (entry->offset() != end || !entry_is_sound(*entry, root->signatures())) {
      return {ErrorCode::kBadStructure, static_cast<std::int64_t>(entry->offset())};
    }
    end += entry->stored_size();
  }
  if (end != tail.index_offset) {
    return {ErrorCode::kBadStructure, static_cast<std::int64_t>(end)};
  }
  return root;
}

Result<ByteSpan> decode_chunk(const fb::ChunkEntry& entry, ByteSpan stored,
                              std::byte* out) noexcept {
  const auto at = static_cast<std::int64_t>(entry.offset());
  if (stored.size() != entry.stored_size()) return {ErrorCode::kTruncated, at};
  if (xxh3(stored) != entry.xxh3()) return {ErrorCode::kBadChecksum, at};
  if (entry.codec() == fb::ChunkCodec::Raw) {
    if (stored.data() != out) std::memcpy(out, stored.data(), stored.size());
  } else {
    const int decoded = LZ4_decompress_safe(
        reinterpret_cast<const char*>(stored.data()), reinterpret_cast<char*>(out),
        static_cast<int>(stored.size()), static_cast<int>(entry.decoded_size()));
    if (decoded < 0 || static_cast<std::uint32_t>(decoded) != entry.decoded_size()) {
      return {ErrorCode::kBadCompression, at};
    }
  }
  const ByteSpan chunk{out, entry.decoded_size()};
  if (const Result<void> sound = check_chunk(chunk, entry); !sound) {
    if (excess_of(sound.error())) return sound.error();
    return {sound.error().code, at};
  }
  return chunk;
}

std::string index_fault_text(const Error& error) {
  if (const auto excess = excess_of(error)) return to_string(*excess);
  const std::string detail = std::to_string(error.detail);
  switch (error.code) {
    case ErrorCode::kTooLarge:
      return "its index takes " + detail + " bytes, more than its chunks need";
    case ErrorCode::kBadValue:
      return "zone in its index is not what a zone may be called";
    case ErrorCode::kMismatch:
      return "slots of " + detail + " bytes, this format has " + std::to_string(kSlotBytes);
    case ErrorCode::kBadStructure:
      return "the index breaks the rules of the format at byte " + detail;
    default:
      return std::string(to_string(error.code)) + " (" + detail + ")";
  }
}

std::uint64_t Placement::room() const noexcept {
  const std::uint64_t at = (end_ + kChunkAlignment - 1) / kChunkAlignment * kChunkAlignment;
  if (slots_ == 0 || chunks_ == kMaxChunksPerSlot || at >= kSlotBytes) return 0;
  return kSlotBytes - at;
}

Placement::Place Placement::add(std::uint32_t decoded_size) noexcept {
  if (decoded_size > room()) {
    ++slots_;
    chunks_ = 1;
    end_ = decoded_size;
    return {slots_ - 1, 0};
  }
  const std::uint64_t at = (end_ + kChunkAlignment - 1) / kChunkAlignment * kChunkAlignment;
  ++chunks_;
  end_ = at + decoded_size;
  return {slots_ - 1, static_cast<std::uint32_t>(at)};
}

std::uint32_t slots_needed(const fb::PackIndex& index, PayloadMask wanted) noexcept {
  const PayloadMask mask = payload_closure(wanted, index.grid_needs_scan());
  Placement placement;
  for (const fb::ChunkEntry* entry : *index.chunks()) {
    if ((mask & mask_of(entry->kind())) != 0) placement.add(entry->decoded_size());
  }
  return placement.slots();
}

}  // namespace zonepack
