// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "platform/base/byte_count.hpp"
#include "platform/base/result.hpp"
#include "platform/files/storage.hpp"
#include "runtime/map/catalog.hpp"
#include "runtime/pack_format/file/geometry.hpp"
#include "runtime/pack_format/file/manifest_file.hpp"

namespace zonepack {

// The position of every signature of the map, loaded or not: the coarse nodes of the manifest. They
// stay in the file; memory holds a checksum and a box for each block of kBlockNodes, so that what
// is read later is known to be unchanged since the start.
//
// Bounds: read() reads one block (10 KiB), nearest() at most kMostBlocks, and it looks at every
// block's box.
// Threads: one, the server's; reads the file.
class NodeStore {
 public:
  static constexpr std::uint32_t kBlockNodes = 512;
  static constexpr std::size_t kMostBlocks = 64;

  struct Found {
    double distance_m = 0;
    ZoneId zone = kNoZone;
    fb::Node node;
  };
  struct Query {
    Point2 at;
    double radius_m = 0;
    std::size_t most = 1;
  };

  // Reads and checks the manifest of the catalog's folder once more; all of it is in memory until
  // this returns. kMismatch: it is another version than the catalog's; and the errors of
  // check_manifest.
  static Result<NodeStore> open(const Catalog& catalog);

  // 0 for a map that was packed without nodes.
  std::uint32_t count(ZoneId zone) const noexcept;

  // The nodes of a zone from `first` on, at most to the end of its block; valid until the next
  // call. kNotFound from the end on; kIo, kTruncated; kBadChecksum: the file was changed in place.
  Result<std::span<const fb::Node>> read(ZoneId zone, std::uint32_t first);

  // The nodes nearest to a point in the plane: by distance, then zone, then id. `accept(zone)` says
  // whose nodes count. False when kMostBlocks were too few to be sure that these are the nearest;
  // each is correct in itself. Errors as of read().
  Result<bool> nearest(const Query& query, const std::function<bool(ZoneId)>& accept,
                       std::vector<Found>& found);

  static ByteCount table_bytes(std::size_t zones, std::uint64_t signatures) noexcept {
    return zones * (sizeof(Place) + sizeof(Block)) + signatures / kBlockNodes * sizeof(Block);
  }

 private:
  struct Place {
    std::uint64_t offset = 0;  // of the nodes in the file
    std::uint32_t count = 0;
    std::uint32_t first_block = 0;
  };
  struct Block {
    std::uint64_t checksum = 0;
    float min_x = 0, min_y = 0, max_x = 0, max_y = 0;
  };
  struct Candidate {
    double distance_m = 0;
    ZoneId zone = kNoZone;
    std::uint32_t block = 0;  // of the zone
  };

  explicit NodeStore(StorageFile file) : file_(std::move(file)) {}
  void index(const fb::Manifest& manifest, ByteSpan file);
  static bool farther(const Candidate& a, const Candidate& b) noexcept;
  void list_blocks(const Query& query, const std::function<bool(ZoneId)>& accept);

  StorageFile file_;
  std::vector<Place> places_;
  std::vector<Block> blocks_;
  std::vector<fb::Node> block_nodes_;
  std::vector<Candidate> candidates_;  // the kMostBlocks + 1 nearest blocks, nearest first
};

}  // namespace zonepack
