// SPDX-License-Identifier: Apache-2.0
// usage: block_bench MAP: what it takes to find a block of voxels in a zone in memory, to decode
// it, and to read one voxel in place; of the largest zone of an nvblox map.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "packer/decode/map_reader.hpp"
#include "runtime/client/block_view.hpp"

using namespace zonepack;

namespace {

double now_ns() {
  return static_cast<double>(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                 std::chrono::steady_clock::now().time_since_epoch())
                                 .count());
}

// Nanoseconds of one call of fn(i) for i of 0 to count.
template <typename Fn>
double each(std::size_t count, Fn&& fn) {
  const double begin = now_ns();
  for (std::size_t i = 0; i < count; ++i) fn(i);
  return (now_ns() - begin) / static_cast<double>(count);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const packer::MapReader map(argv[1]);
  const auto& zones = *map.manifest().zones();
  const fb::Zone* const zone = *std::max_element(
      zones.begin(), zones.end(),
      [](const fb::Zone* a, const fb::Zone* b) { return a->pack_bytes() < b->pack_bytes(); });
  const PackReader pack = map.open_pack(*zone);
  const double begin = now_ns();
  const auto decoded = DecodedPack::decode(pack, kDefaultPayload);
  const double opened = now_ns();
  if (!decoded) return 1;
  const BlocksView blocks(decoded->view());
  if (blocks.size() == 0) return 1;
  std::mt19937 engine(1);
  std::vector<BlockPosition> order;
  blocks.for_each([&](const BlockView& block) { order.push_back(block.position()); });
  std::shuffle(order.begin(), order.end(), engine);
  std::size_t found = 0;
  const std::size_t calls = std::max<std::size_t>(order.size(), 200'000);
  const double find = each(calls, [&](std::size_t i) {
    const BlockPosition& p = order[i % order.size()];
    found += blocks.find(p.x, p.y, p.z).has_value();
  });
  const double miss = each(calls, [&](std::size_t i) {
    const BlockPosition& p = order[i % order.size()];
    found += blocks.find(p.x, p.y, p.z + 100'000).has_value();
  });
  std::array<TsdfVoxel, kVoxelsOfBlock> voxels;
  float sum = 0;
  const double copy = each(calls / 10, [&](std::size_t i) {
    const BlockPosition& p = order[i % order.size()];
    if (const auto block = blocks.find(p.x, p.y, p.z)) block->copy_tsdf(voxels);
    sum += voxels[i % kVoxelsOfBlock].distance_m;
  });
  const double at = each(calls, [&](std::size_t i) {
    const BlockPosition& p = order[i % order.size()];
    const auto block = blocks.find(p.x, p.y, p.z);
    const auto voxel = block ? block->tsdf_at(i & 7, i >> 3 & 7, i >> 6 & 7) : std::nullopt;
    sum += voxel ? voxel->distance_m : 0;
  });
  std::printf("zone %s: %u blocks, read, checked and indexed in %.1f ms\n", zone->name()->c_str(),
              blocks.size(), (opened - begin) / 1e6);
  std::printf(
      "find %.0f ns, find what is not there %.0f ns, find and copy 512 voxels %.2f us, find and "
      "read one voxel %.0f ns (%zu found, sum %g)\n",
      find, miss, copy / 1e3, at, found, static_cast<double>(sum));
}
