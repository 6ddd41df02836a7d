// SPDX-License-Identifier: Apache-2.0
// Signatures through a pack and back, bit for bit.
#include <gtest/gtest.h>

#include "packer/decode/record_decoder.hpp"
#include "packer/encode/pack_writer.hpp"
#include "packer/sources/rtabmap/rtabmap_database.hpp"
#include "runtime/pack_format/file/pack_reader.hpp"
#include "tests/support/rtabmap_fixture.hpp"
#include "tests/support/signature_recipe.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

using test_support::TemporaryFolder;

PackSummary pack_all(RtabmapDatabase& database, const TemporaryFolder& folder) {
  PackWriter writer(folder.path(), "all");
  for (const NodeOutline& node : database.outline().nodes) {
    SignatureRecord record = database.read(node.id, PayloadSet());
    writer.add(record, 0, 0);
  }
  return writer.finish(kEveryPayload);
}

void expect_round_trip(const std::filesystem::path& path) {
  RtabmapDatabase database(path);
  const TemporaryFolder folder;
  const PackSummary summary = pack_all(database, folder);
  const Result<PackReader> reader = PackReader::open(folder / summary.file, &summary.digest);
  ASSERT_TRUE(reader.ok()) << to_string(reader.error().code);
  const Result<DecodedPack> pack = DecodedPack::decode(*reader, kEveryPayload);
  ASSERT_TRUE(pack.ok()) << to_string(pack.error().code) << " at " << pack.error().detail;
  ASSERT_EQ(pack->view().size(), database.outline().nodes.size());
  for (std::uint32_t i = 0; i < pack->view().size(); ++i) {
    const SignatureRecord expected = database.read(database.outline().nodes[i].id, PayloadSet());
    EXPECT_EQ(test_support::first_difference(expected, decode_record(pack->view(), i)), "")
        << "signature " << expected.id;
  }
}

TEST(PackRoundTrip, GivesEverySignatureOfTheSampleMapBackBitForBit) {
  expect_round_trip(std::string(ZONEPACK_TEST_DATA) + "/hospital-small.db");
}

class PackRoundTripOfSchema : public testing::TestWithParam<const char*> {};

TEST_P(PackRoundTripOfSchema, GivesOneOfEverythingBackBitForBit) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "map.db";
  test_support::write_rtabmap_database(path, test_support::one_of_everything(GetParam()));
  expect_round_trip(path);
}

INSTANTIATE_TEST_SUITE_P(Schemas, PackRoundTripOfSchema,
                         testing::Values("0.18.0", "0.20.0", "0.22.0", "0.23.8"));

}  // namespace
}  // namespace zonepack::packer
