// SPDX-License-Identifier: Apache-2.0
#include "runtime/recording/map_block.hpp"

#include <algorithm>

#include "platform/base/require.hpp"
#include "runtime/pack_format/limits.hpp"
#include "runtime/recording/block.hpp"

namespace zonepack {
namespace {

constexpr std::size_t kMapBlockContent = std::size_t{512} * 1024;
constexpr std::size_t kMapHeadRoom = 64;
constexpr std::uint32_t kFirstOfAnOffer = 2;
constexpr std::uint64_t kMostMapBytes = kMaxManifestBytes + kMiB;

}  // namespace

std::vector<std::byte> write_map(const RecordedMap& map) {
  std::vector<std::byte> content(kMapHeadRoom + map.folder.size() + map.manifest.size());
  ByteWriter out(content);
  out.u32(map.number);
  out.u64(map.manifest.size());
  out.varint(map.folder.size());
  out.bytes(std::as_bytes(std::span(map.folder)));
  out.bytes(map.manifest);
  ZP_REQUIRE(out.ok());
  std::vector<std::byte> blocks, block;
  blocks.reserve(out.written().size() + out.written().size() / 64 + kMapHeadRoom);
  for (ByteSpan rest = out.written(); !rest.empty();) {
    const ByteSpan part = rest.first(std::min(rest.size(), kMapBlockContent));
    seal_block(BlockKind::kMap, part, block);
    blocks.insert(blocks.end(), block.begin(), block.end());
    rest = rest.subspan(part.size());
  }
  return blocks;
}

Result<void> RecordedMaps::add(ByteSpan content) {
  begun_.insert(begun_.end(), content.begin(), content.end());
  ByteReader in(begun_);
  RecordedMap map;
  map.number = in.u32();
  const std::uint64_t size = in.u64();
  const ByteSpan folder = in.bytes(in.varint());
  if (!in.ok() || map.number < kFirstOfAnOffer || size == 0 || size > kMostMapBytes) {
    begun_.clear();
    return size > kMostMapBytes ? ErrorCode::kTooLarge : ErrorCode::kBadStructure;
  }
  if (in.left() < size) return {};
  const ByteSpan manifest = in.bytes(size);
  map.folder.assign(reinterpret_cast<const char*>(folder.data()), folder.size());
  map.manifest.assign(manifest.begin(), manifest.end());
  const bool whole = in.finished();
  if (whole) maps_[map.number] = std::move(map);
  begun_.clear();
  return whole ? Result<void>() : Result<void>(ErrorCode::kBadStructure);
}

const RecordedMap* RecordedMaps::find(std::uint32_t number) const noexcept {
  const auto found = maps_.find(number);
  return found == maps_.end() ? nullptr : &found->second;
}

}  // namespace zonepack
