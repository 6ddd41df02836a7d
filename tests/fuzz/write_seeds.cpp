// SPDX-License-Identifier: Apache-2.0
// Writes the seeds of every fuzz target below a folder: write_fuzz_seeds FOLDER.
#include <cstdio>
#include <filesystem>

#include "tests/fuzz/input_seeds.hpp"
#include "tests/fuzz/nvblox_entries.hpp"
#include "tests/fuzz/seeds.hpp"
#include "tests/support/memory_folder.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: write_fuzz_seeds FOLDER\n", stderr);
    return 2;
  }
  const auto write = [&](const char* target, const std::vector<zonepack::packer::Bytes>& seeds) {
    const std::filesystem::path folder = std::filesystem::path(argv[1]) / target;
    std::filesystem::create_directories(folder);
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      zonepack::test_support::write_bytes(folder / std::to_string(i), seeds[i]);
    }
  };
  const zonepack::fuzz::Seeds& seeds = zonepack::fuzz::seeds();
  write("pack", seeds.packs);
  write("index", seeds.indexes);
  write("chunk", seeds.chunks);
  write("block", seeds.blocks);
  write("manifest", seeds.manifests);
  write("dbc", seeds.dbcs);
  const zonepack::fuzz::InputSeeds& inputs = zonepack::fuzz::input_seeds();
  write("geojson", inputs.geojson);
  write("settings", inputs.settings);
  write("sqlite", inputs.sqlite);
  write("msgpack", inputs.msgpack);
  write("pcd", inputs.pcd);
  write("recording", inputs.recordings);
  write("protocol", inputs.messages);
  write("voxels", zonepack::fuzz::nvblox_seeds().voxels);
  write("nvblox", zonepack::fuzz::nvblox_seeds().files);
  return 0;
}
