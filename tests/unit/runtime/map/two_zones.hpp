// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/map/loader.hpp"
#include "tests/support/small_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::test_support {

// A map of the zones a and b on disk, and what it takes to load them.
class TwoZones {
 public:
  // `signatures` with 300 features and a scan in each; a kilobyte of 30 or so each.
  explicit TwoZones(std::int32_t signatures)
      : map_(recipes(1, signatures, 2), recipes(1 + signatures, signatures, 6)),
        buffer_(kReadBufferBytes) {
    for (const auto& [name, bytes] : map_.folder.files) write_bytes(disk_ / name, bytes);
    catalog_ = Catalog::open(disk_.path().string(), kDefaultPayload).value();
    for (const CatalogZone& zone : catalog_.zones) {
      while (slots_.size() < zone.slots) {
        memory_.push_back(std::make_unique<Slot>());
        slots_.push_back(memory_.back()->bytes);
      }
    }
  }

  const Catalog& catalog() const { return catalog_; }
  std::filesystem::path pack(ZoneId zone) const { return disk_ / catalog_.zones[zone].pack; }

  Result<ZoneLoad> begin(ZoneId zone, ReadMode mode) {
    return ZoneLoad::begin(catalog_, zone, slots_, buffer_, {mode, queue_.get()});
  }

  // The decoded chunks of a zone, or why there are none.
  Result<packer::Bytes> load(ZoneId zone, ReadMode mode) {
    Result<ZoneLoad> load = begin(zone, mode);
    if (!load) return load.error();
    return finish(*load);
  }
  static Result<packer::Bytes> finish(ZoneLoad& load) {
    for (;;) {
      const Result<bool> more = load.step();
      if (!more) return more.error();
      if (!*more) break;
    }
    packer::Bytes bytes;
    for (const ChunkRef& chunk : load.chunks()) {
      bytes.insert(bytes.end(), chunk.bytes.begin(), chunk.bytes.end());
    }
    return bytes;
  }

 private:
  struct alignas(64) Slot {
    std::byte bytes[kSlotBytes];
  };

  static std::vector<SignatureRecipe> recipes(std::int32_t first, std::int32_t count, float x) {
    std::vector<SignatureRecipe> all;
    for (std::int32_t i = 0; i < count; ++i) {
      SignatureRecipe& recipe = all.emplace_back();
      recipe.id = first + i;
      recipe.x = x;
      recipe.y = 2;
      recipe.features = 300;
    }
    return all;
  }

  SmallMap map_;
  TemporaryFolder disk_;
  Catalog catalog_;
  std::vector<std::unique_ptr<Slot>> memory_;
  std::vector<std::byte*> slots_;
  std::vector<std::byte> buffer_;
  std::unique_ptr<ReadQueue> queue_ = ReadQueue::make();
};

}  // namespace zonepack::test_support
