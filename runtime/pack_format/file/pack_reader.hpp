// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "platform/base/result.hpp"
#include "platform/files/storage.hpp"
#include "runtime/pack_format/file/pack_file.hpp"
#include "runtime/pack_format/zone_view.hpp"

namespace zonepack {

// How a pack is read; StorageFile::open() says what kDirect means without a queue.
struct PackReading {
  // NOLINTNEXTLINE(google-explicit-constructor): a mode is a way of reading
  PackReading(ReadMode how = ReadMode::kCached, ReadQueue* by = nullptr) : mode(how), queue(by) {}

  ReadMode mode;
  ReadQueue* queue;
  ByteCount most_index_bytes = kMaxIndexBytes;  // refused beyond, before memory is taken for it
};

// An open pack with its index read and checked.
//
// Header, index and tail are copied out as the mode says: from mapped windows or, by default, by
// pread, which takes 2 us, while mapping and unmapping a window takes 20 to 70 us and interrupts
// every core that runs a thread of this process, including the control thread.
class PackReader {
 public:
  // With `expected`: kMismatch for a whole pack with another digest. kTooLarge with its size: the
  // index is longer than the reading allows. `soon`: bytes from the front
  // that the caller reads next by windows; where the mode reads ahead, fetching them starts
  // together with the index, and front_asked() returns how many were requested.
  static Result<PackReader> open(const std::string& path, const Digest32* expected = nullptr,
                                 const PackReading& reading = {}, std::uint64_t soon = 0);

  const fb::PackIndex& index() const noexcept { return *index_; }
  const PackTail& tail() const noexcept { return tail_; }
  std::uint64_t front_asked() const noexcept { return front_asked_; }
  const StorageFile& file() const noexcept { return file_; }
  StorageFile& file() noexcept { return file_; }

 private:
  PackReader(StorageFile file, const PackTail& tail, std::uint64_t front_asked)
      : file_(std::move(file)),
        tail_(tail),
        front_asked_(front_asked),
        words_(static_cast<std::size_t>((tail.index_size + 7) / 8)) {}
  StorageFile file_;
  PackTail tail_;
  std::uint64_t front_asked_;
  std::vector<std::uint64_t> words_;  // the index, aligned
  const fb::PackIndex* index_ = nullptr;
};

// A pack's chunks of some kinds decoded into memory of its own, for tools and tests. The robot
// decodes into its arena instead (runtime/map/loader.hpp).
class DecodedPack {
 public:
  // Errors: those of reading and decoding, and kMismatch of ZoneView; detail is the file offset.
  // Decodes only chunks that hold something of the range.
  static Result<DecodedPack> decode(const PackReader& pack, PayloadMask wanted,
                                    OrdinalRange range = {});

  const ZoneView& view() const noexcept { return *view_; }
  const std::vector<ChunkRef>& chunks() const noexcept { return chunks_; }

 private:
  struct alignas(64) Line {
    std::byte bytes[64];
  };
  std::vector<std::vector<Line>> memory_;
  std::vector<ChunkRef> chunks_;
  std::unique_ptr<ZoneView> view_;
};

}  // namespace zonepack
