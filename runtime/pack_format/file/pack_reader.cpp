// SPDX-License-Identifier: Apache-2.0
#include "runtime/pack_format/file/pack_reader.hpp"

#include <algorithm>
#include <array>

namespace zonepack {
namespace {

constexpr std::uint64_t kUsualIndexBytes = 16 * kKiB;  // with the tail
constexpr std::uint64_t kFirstBytes = 256 * kKiB;

}  // namespace

Result<PackReader> PackReader::open(const std::string& path, const Digest32* expected,
                                    const PackReading& reading, std::uint64_t soon) {
  Result<StorageFile> file = StorageFile::open(path, reading.mode, reading.queue);
  if (!file) return file.error();
  if (file->size() < sizeof(PackHeader) + sizeof(PackTail)) {
    return {ErrorCode::kTruncated, static_cast<std::int64_t>(file->size())};
  }
  // Requests the end first, because it is read first; a short file takes one request.
  const std::uint64_t end_bytes = std::min<std::uint64_t>(file->size(), kUsualIndexBytes);
  if (!file->reads_ahead()) soon = 0;
  const bool direct = file->mode() == ReadMode::kDirect;
  const std::uint64_t most = direct ? file->most_ahead() : kFirstBytes;
  std::uint64_t front = file->size();
  if (soon == 0 || direct || file->size() > most) {
    front = std::clamp<std::uint64_t>(soon, sizeof(PackHeader), std::min(front, most));
    file->expect(file->size() - end_bytes, end_bytes);
  }
  file->read_ahead(0, front);
  alignas(8) std::array<std::byte, kUsualIndexBytes> end;
  const auto last = std::span(end).last(static_cast<std::size_t>(end_bytes));
  if (const auto read = file->read_at(file->size() - last.size(), last); !read) {
    return read.error();
  }
  const Result<PackTail> tail = check_tail(last.last<sizeof(PackTail)>(), file->size());
  if (!tail) return tail.error();
  if (expected != nullptr && tail->digest != *expected) return ErrorCode::kMismatch;
  if (tail->index_size > reading.most_index_bytes) {
    return {ErrorCode::kTooLarge, static_cast<std::int64_t>(tail->index_size)};
  }
  std::array<std::byte, sizeof(PackHeader)> header;
  if (const auto read = file->read_at(0, header); !read) return read.error();

  PackReader reader(std::move(*file), *tail, front);
  const auto index = std::as_writable_bytes(std::span(reader.words_))
                         .first(static_cast<std::size_t>(tail->index_size));
  if (const std::size_t have = last.size() - sizeof(PackTail); index.size() <= have) {
    std::ranges::copy(last.subspan(have - index.size(), index.size()), index.begin());
  } else if (const auto read = reader.file_.read_at(tail->index_offset, index); !read) {
    return read.error();
  }
  const Result<const fb::PackIndex*> checked = check_index(header, index, *tail);
  if (!checked) return checked.error();
  reader.index_ = *checked;
  return reader;
}

Result<DecodedPack> DecodedPack::decode(const PackReader& pack, PayloadMask wanted,
                                        OrdinalRange range) {
  DecodedPack decoded;
  const PayloadMask mask = payload_closure(wanted, pack.index().grid_needs_scan());
  std::vector<std::byte> stored;
  for (const fb::ChunkEntry* entry : *pack.index().chunks()) {
    if ((mask & mask_of(entry->kind())) == 0) continue;
    if (entry->last_signature() < range.first || range.last < entry->first_signature()) continue;
    stored.resize(entry->stored_size());
    if (const auto read = pack.file().read_at(entry->offset(), stored); !read) return read.error();
    std::vector<Line>& memory = decoded.memory_.emplace_back((entry->decoded_size() + 63) / 64);
    const auto chunk = decode_chunk(*entry, stored, reinterpret_cast<std::byte*>(memory.data()));
    if (!chunk) return chunk.error();
    decoded.chunks_.push_back({entry->kind(), *chunk});
  }
  Result<ZoneView> view = ZoneView::make(decoded.chunks_, range);
  if (!view) return view.error();
  decoded.view_ = std::make_unique<ZoneView>(std::move(*view));
  return decoded;
}

}  // namespace zonepack
