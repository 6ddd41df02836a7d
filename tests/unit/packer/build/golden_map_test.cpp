// SPDX-License-Identifier: Apache-2.0
// A map written once in version 1.0 of the format: later versions must read it.
#include <gtest/gtest.h>
#include <lz4.h>

#include <fstream>
#include <set>
#include <string>

#include "packer/decode/record_decoder.hpp"
#include "packer/encode/pack_writer.hpp"
#include "packer/verify/map_verifier.hpp"
#include "platform/files/storage.hpp"
#include "runtime/map/catalog.hpp"
#include "runtime/pack_format/file/pack_reader.hpp"
#include "tests/support/memory_folder.hpp"
#include "tests/support/record_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

const std::filesystem::path kGolden = std::string(ZONEPACK_SOURCE_DIR) + "/tests/golden";

class GoldenMap : public testing::Test {
 protected:
  GoldenMap() : file_(*read_file((kGolden / "map/manifest.zpm").string(), 1 << 20)) {
    manifest_ = *check_manifest(file_);
  }

  PackReader pack_of(const fb::Zone& zone) {
    return PackReader::open((kGolden / "map" / zone.pack()->str()).string()).value();
  }

  std::vector<std::byte> file_;
  const fb::Manifest* manifest_ = nullptr;
};

// The first line in which two texts differ, so that a failure can be read.
std::string first_difference(const std::string& a, const std::string& b) {
  std::istringstream lines_a(a), lines_b(b);
  std::string line_a, line_b;
  for (int line = 1;; ++line) {
    const bool more_a = !!std::getline(lines_a, line_a);
    const bool more_b = !!std::getline(lines_b, line_b);
    if (!more_a && !more_b) return "";
    if (more_a != more_b || line_a != line_b) {
      return "line " + std::to_string(line) + ": " + line_a + " != " + line_b;
    }
  }
}

std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST_F(GoldenMap, IsWhole) {
  const Verdict verdict = verify_map(FolderFiles(kGolden / "map"));
  for (const Problem& problem : verdict.problems) ADD_FAILURE() << to_string(problem);
  EXPECT_EQ(verdict.packs, 3u);
  EXPECT_EQ(verdict.signatures, 8u);
}

TEST_F(GoldenMap, ManifestHoldsWhatItsJsonFileSays) {
  EXPECT_EQ(first_difference(test_support::to_json(*manifest_).dump(1) + "\n",
                             read_text(kGolden / "manifest.json")),
            "");
}

TEST_F(GoldenMap, PacksHoldWhatTheirJsonFilesSay) {
  for (const fb::Zone* zone : *manifest_->zones()) {
    const PackReader reader = pack_of(*zone);
    const auto pack = DecodedPack::decode(reader, kEveryPayload);
    ASSERT_TRUE(pack.ok()) << zone->name()->str();
    std::string text;
    for (std::uint32_t i = 0; i < pack->view().size(); ++i) {
      text += test_support::to_json(decode_record(pack->view(), i)).dump() + "\n";
    }
    EXPECT_EQ(first_difference(text, read_text(kGolden / (zone->name()->str() + ".jsonl"))), "")
        << zone->name()->str();
  }
}

TEST_F(GoldenMap, CoversKindsCodecsAndTablesOverSeveralChunks) {
  std::set<fb::PayloadKind> kinds;
  std::set<fb::ChunkCodec> chunk_codecs;
  std::set<fb::ColumnCodec> column_codecs;
  std::set<fb::Part> parts;
  std::size_t continued_tables = 0;
  for (const fb::Zone* zone : *manifest_->zones()) {
    const PackReader reader = pack_of(*zone);
    const auto pack = DecodedPack::decode(reader, kEveryPayload);
    ASSERT_TRUE(pack.ok());
    for (const fb::ChunkEntry* entry : *reader.index().chunks()) {
      kinds.insert(entry->kind());
      chunk_codecs.insert(entry->codec());
    }
    for (const ChunkRef& chunk : pack->chunks()) {
      if (chunk.kind == fb::PayloadKind::Core) continue;
      const fb::BulkChunk& bulk = *fb::GetBulkChunk(chunk.bytes.data());
      for (const fb::Column* column : *bulk.columns()) column_codecs.insert(column->codec());
      for (const fb::Record* record : *bulk.records()) {
        parts.insert(record->part());
        continued_tables += record->first_row() > 0;
      }
    }
  }
  EXPECT_EQ(kinds.size(), 7u);
  EXPECT_EQ(chunk_codecs.size(), 2u);
  EXPECT_EQ(column_codecs.size(), 7u);
  EXPECT_GE(parts.size(), 11u);
  EXPECT_GE(continued_tables, 2u);
}

// The stored bytes of raw chunks do not depend on liblz4; those of LZ4 chunks do, and with them the
// places of all that follows, so with another liblz4 the chunks are compared decoded.
TEST_F(GoldenMap, SignaturesEncodedAgainGiveTheSamePacks) {
  const bool same_lz4 =
      manifest_->provenance()->lz4_version() == static_cast<std::uint32_t>(LZ4_versionNumber());
  for (const fb::Zone* zone : *manifest_->zones()) {
    const std::string name = zone->name()->str();
    const PackReader golden = pack_of(*zone);
    const auto decoded = DecodedPack::decode(golden, kEveryPayload);
    ASSERT_TRUE(decoded.ok()) << name;

    const test_support::TemporaryFolder folder;
    PackWriter writer(folder.path(), name);
    for (std::uint32_t i = 0; i < decoded->view().size(); ++i) {
      SignatureRecord record = decode_record(decoded->view(), i);
      const Transform T = record.pose ? *record.pose : *record.odometry_pose;
      writer.add(record, T[3], T[7]);
    }
    const PackSummary again = writer.finish(kEveryPayload);
    const PackReader reader = PackReader::open((folder / again.file).string()).value();
    const auto decoded_again = DecodedPack::decode(reader, kEveryPayload);
    ASSERT_TRUE(decoded_again.ok()) << name;
    ASSERT_EQ(decoded_again->chunks().size(), decoded->chunks().size()) << name;
    for (std::size_t i = 0; i < decoded->chunks().size(); ++i) {
      const ByteSpan a = decoded->chunks()[i].bytes, b = decoded_again->chunks()[i].bytes;
      EXPECT_TRUE(std::ranges::equal(a, b)) << name << ", chunk " << i << " once decoded";
    }
    if (same_lz4) {
      EXPECT_EQ(test_support::read_bytes(folder / again.file),
                test_support::read_bytes(kGolden / "map" / zone->pack()->str()))
          << name;
    }
  }
}

}  // namespace
}  // namespace zonepack::packer
