// SPDX-License-Identifier: Apache-2.0
// usage: make_hostile_map GOOD_MAP KIND INTO: writes the hostile map of that kind, of the lineage
// of the good map. make_hostile_map: lists the kinds, each with the file that a refusal names.
#include <cstdio>
#include <filesystem>

#include "platform/files/storage.hpp"
#include "runtime/pack_format/file/manifest_file.hpp"
#include "tests/support/hostile_map.hpp"
#include "tests/support/temporary_folder.hpp"

int main(int argc, char** argv) {
  using namespace zonepack;
  if (argc == 1) {
    for (const auto& [name, file] : test_support::hostile_kinds())
      std::printf("%s\t%s\n", name, file);
    return 0;
  }
  if (argc != 4) return 2;
  const auto good =
      read_file(std::string(argv[1]) + "/" + std::string(kManifestName), kMaxManifestFileBytes);
  if (!good) return 1;
  const auto manifest = check_manifest(*good);
  if (!manifest) return 1;
  const auto& lineage = *(*manifest)->lineage();
  const auto map = test_support::hostile_map(argv[2], {lineage.data(), lineage.size()});
  std::filesystem::create_directories(argv[3]);
  for (const auto& [name, bytes] : map.files) {
    test_support::write_bytes(std::filesystem::path(argv[3]) / name, bytes);
  }
  return 0;
}
