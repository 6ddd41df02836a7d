// SPDX-License-Identifier: Apache-2.0
#include "runtime/serve/node_store.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "platform/base/require.hpp"

namespace zonepack {
namespace {

std::uint32_t blocks_of(std::uint32_t nodes) noexcept {
  return (nodes + NodeStore::kBlockNodes - 1) / NodeStore::kBlockNodes;
}

double length(double dx, double dy) noexcept { return std::sqrt(dx * dx + dy * dy); }

bool nearer(const NodeStore::Found& a, const NodeStore::Found& b) noexcept {
  return std::tuple(a.distance_m, a.zone, a.node.id()) <
         std::tuple(b.distance_m, b.zone, b.node.id());
}

}  // namespace

Result<NodeStore> NodeStore::open(const Catalog& catalog) {
  const std::string path = catalog.folder + "/" + std::string(kManifestName);
  Result<StorageFile> file = StorageFile::open(path);
  if (!file) return file.error();
  if (kManifestHeldTimes * file->size() != catalog.reading_bytes) return ErrorCode::kMismatch;
  // A manifest is far shorter than what 32 bits can address (kMaxManifestBytes).
  std::vector<std::byte> bytes(static_cast<std::size_t>(file->size()));
  if (const Result<void> read = file->read_at(0, bytes); !read) return read.error();
  const Result<const fb::Manifest*> manifest = check_manifest(bytes);
  if (!manifest) return manifest.error();
  if (manifest_digest(bytes) != catalog.version) return ErrorCode::kMismatch;
  NodeStore store(std::move(file).value());
  store.index(**manifest, bytes);
  return store;
}

void NodeStore::index(const fb::Manifest& manifest, ByteSpan file) {
  places_.reserve(manifest.zones()->size());
  std::size_t all_blocks = 0;
  for (const fb::Zone* zone : *manifest.zones()) {
    if (zone->nodes() != nullptr) all_blocks += blocks_of(zone->nodes()->size());
  }
  blocks_.reserve(all_blocks);
  block_nodes_.resize(kBlockNodes);
  candidates_.reserve(kMostBlocks + 2);
  for (const fb::Zone* zone : *manifest.zones()) {
    Place& place = places_.emplace_back();
    if (zone->nodes() == nullptr) continue;
    const auto* const begin = reinterpret_cast<const std::byte*>(zone->nodes()->Data());
    place.offset = static_cast<std::uint64_t>(begin - file.data());
    place.count = zone->nodes()->size();
    place.first_block = static_cast<std::uint32_t>(blocks_.size());
    for (std::uint32_t first = 0; first < place.count; first += kBlockNodes) {
      const std::uint32_t end = std::min(first + kBlockNodes, place.count);
      Block& block = blocks_.emplace_back();
      block.checksum =
          xxh3(file.subspan(static_cast<std::size_t>(place.offset) + first * sizeof(fb::Node),
                            (end - first) * sizeof(fb::Node)));
      block.min_x = block.min_y = INFINITY;
      block.max_x = block.max_y = -INFINITY;
      for (std::uint32_t i = first; i < end; ++i) {
        const fb::Node& node = *zone->nodes()->Get(i);
        block.min_x = std::min(block.min_x, node.x());
        block.min_y = std::min(block.min_y, node.y());
        block.max_x = std::max(block.max_x, node.x());
        block.max_y = std::max(block.max_y, node.y());
      }
    }
  }
}

std::uint32_t NodeStore::count(ZoneId zone) const noexcept {
  return zone < places_.size() ? places_[zone].count : 0;
}

Result<std::span<const fb::Node>> NodeStore::read(ZoneId zone, std::uint32_t first) {
  if (first >= count(zone)) return ErrorCode::kNotFound;
  const Place& place = places_[zone];
  const std::uint32_t block = first / kBlockNodes;
  const std::uint32_t begin = block * kBlockNodes;
  const std::uint32_t nodes = std::min(kBlockNodes, place.count - begin);
  const std::span<fb::Node> into(block_nodes_.data(), nodes);
  const std::uint64_t offset = place.offset + begin * sizeof(fb::Node);
  if (const auto read = file_.read_at(offset, std::as_writable_bytes(into)); !read) {
    return read.error();
  }
  if (xxh3(std::as_bytes(into)) != blocks_[place.first_block + block].checksum) {
    return {ErrorCode::kBadChecksum, static_cast<std::int64_t>(offset)};
  }
  return std::span<const fb::Node>(into.subspan(first - begin));
}

bool NodeStore::farther(const Candidate& a, const Candidate& b) noexcept {
  return std::tie(a.distance_m, a.zone, a.block) < std::tie(b.distance_m, b.zone, b.block);
}

void NodeStore::list_blocks(const Query& query, const std::function<bool(ZoneId)>& accept) {
  candidates_.clear();
  for (ZoneId zone = 0; zone < places_.size(); ++zone) {
    const Place& place = places_[zone];
    for (std::uint32_t i = 0; i < blocks_of(place.count); ++i) {
      const Block& block = blocks_[place.first_block + i];
      const double dx = std::max({block.min_x - query.at.x_m, query.at.x_m - block.max_x, 0.0});
      const double dy = std::max({block.min_y - query.at.y_m, query.at.y_m - block.max_y, 0.0});
      const Candidate candidate{length(dx, dy), zone, i};
      if (!(candidate.distance_m <= query.radius_m) || !accept(zone)) continue;
      candidates_.push_back(candidate);
      std::ranges::push_heap(candidates_, farther);
      if (candidates_.size() <= kMostBlocks + 1) continue;
      std::ranges::pop_heap(candidates_, farther);
      candidates_.pop_back();
    }
  }
  std::ranges::sort_heap(candidates_, farther);
}

Result<bool> NodeStore::nearest(const Query& query, const std::function<bool(ZoneId)>& accept,
                                std::vector<Found>& found) {
  list_blocks(query, accept);
  found.clear();
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const Candidate& candidate = candidates_[i];
    if (found.size() == query.most && candidate.distance_m > found.back().distance_m) return true;
    if (i == kMostBlocks) return false;
    const auto nodes = read(candidate.zone, candidate.block * kBlockNodes);
    if (!nodes) return nodes.error();
    for (const fb::Node& node : *nodes) {
      const double distance = length(node.x() - query.at.x_m, node.y() - query.at.y_m);
      if (!(distance <= query.radius_m)) continue;
      const Found entry{distance, candidate.zone, node};
      if (found.size() == query.most && !nearer(entry, found.back())) continue;
      if (found.size() == query.most) found.pop_back();
      found.insert(std::ranges::upper_bound(found, entry, nearer), entry);
    }
  }
  return true;
}

}  // namespace zonepack
