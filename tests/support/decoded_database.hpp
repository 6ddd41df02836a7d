// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "packer/encode/pack_writer.hpp"
#include "packer/sources/rtabmap/rtabmap_database.hpp"
#include "runtime/pack_format/file/pack_reader.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::test_support {

// All signatures of a database in one pack, decoded.
inline DecodedPack decoded_database(const std::filesystem::path& database_path) {
  packer::RtabmapDatabase database(database_path);
  const TemporaryFolder folder;
  packer::PackWriter writer(folder.path(), "all");
  for (const packer::NodeOutline& node : database.outline().nodes) {
    packer::SignatureRecord record = database.read(node.id, packer::PayloadSet());
    writer.add(record, 0, 0);
  }
  const auto reader = PackReader::open(folder / writer.finish(kEveryPayload).file);
  return DecodedPack::decode(*reader, kEveryPayload).value();
}

}  // namespace zonepack::test_support
