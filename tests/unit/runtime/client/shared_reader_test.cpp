// SPDX-License-Identifier: Apache-2.0
#include "runtime/client/shared_reader.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <optional>
#include <random>

#include "packer/decode/record_decoder.hpp"
#include "platform/memory/shared_memory.hpp"
#include "runtime/pack_format/file/pack_reader.hpp"
#include "tests/support/decoded_database.hpp"
#include "tests/support/rtabmap_fixture.hpp"
#include "tests/support/shared_zones.hpp"
#include "tests/support/signature_recipe.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/runtime/client/record_from_view.hpp"

namespace zonepack {
namespace {

using test_support::SharedZones;

DecodedPack one_of_everything() {
  const test_support::TemporaryFolder folder;
  test_support::write_rtabmap_database(folder / "map.db",
                                       test_support::one_of_everything("0.23.8"));
  return test_support::decoded_database(folder / "map.db");
}

const DecodedPack& sample_map() {
  static const DecodedPack decoded =
      test_support::decoded_database(std::string(ZONEPACK_TEST_DATA) + "/hospital-small.db");
  return decoded;
}

// Memory for two zones, of which zone 1 holds one signature of every kind.
class Reader : public testing::Test {
 protected:
  static const DecodedPack& pack() {
    static const DecodedPack decoded = one_of_everything();
    return decoded;
  }
  const std::uint32_t slots = SharedZones::slots_for(pack().chunks());
  SharedMemory memory =
      SharedMemory::create("zonepack-test", shared_map_bytes(2, slots + 1)).value();
  std::optional<SharedZones> zones{std::in_place, memory.bytes(), 2, slots + 1};
  SharedMemory mapped = SharedMemory::map_read_only(memory.reader_file().value()).value();
  SharedReader reader = SharedReader::open(mapped.read_only()).value();
};

void expect_same(const ZoneSignatures& signatures, const ZoneView& expected) {
  ASSERT_EQ(signatures.size(), expected.size());
  for (std::uint32_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(test_support::first_difference(packer::decode_record(expected, i),
                                             test_support::record_from(signatures[i])),
              "")
        << "signature " << signatures[i].id();
  }
}

TEST_F(Reader, ReadsEveryPayloadBitForBitInPlace) {
  zones->put(1, pack().chunks());
  EXPECT_EQ(reader.read(1, [](const ZoneSignatures& z) { expect_same(z, pack().view()); }),
            ReadStatus::kOk);
}

TEST_F(Reader, FindsSignaturesByTheirIds) {
  zones->put(1, pack().chunks());
  EXPECT_EQ(reader.read(1,
                        [](const ZoneSignatures& z) {
                          for (std::uint32_t i = 0; i < z.size(); ++i) {
                            ASSERT_TRUE(z.find(z[i].id()).has_value());
                            EXPECT_EQ(z.find(z[i].id())->stamp_s(), z[i].stamp_s());
                          }
                          EXPECT_FALSE(z.find(0).has_value());
                          EXPECT_FALSE(z.find(1000).has_value());
                        }),
            ReadStatus::kOk);
}

TEST_F(Reader, ReadsAFeatureByItsIndexAsInOrder) {
  zones->put(1, pack().chunks());
  EXPECT_EQ(reader.read(1,
                        [](const ZoneSignatures& z) {
                          const FeaturesView features = z[0].features();
                          ASSERT_EQ(features.size(), 20u);
                          std::uint32_t index = 0;
                          features.for_each([&](const Feature& f) {
                            EXPECT_EQ(features[index].word_id, f.word_id);
                            EXPECT_EQ(features[index++].descriptor.data(), f.descriptor.data());
                          });
                          EXPECT_TRUE(features[20].descriptor.empty());
                        }),
            ReadStatus::kOk);
}

TEST_F(Reader, SaysWhichZonesAreThere) {
  zones->put(1, pack().chunks());
  EXPECT_EQ(reader.zone_count(), 2u);
  EXPECT_TRUE(reader.resident(1));
  EXPECT_FALSE(reader.resident(0));
  const auto never = [](const ZoneSignatures&) { FAIL(); };
  EXPECT_EQ(reader.read(0, never), ReadStatus::kAbsent);
  EXPECT_EQ(reader.read(2, never), ReadStatus::kAbsent);
  zones->remove(1);
  EXPECT_EQ(reader.read(1, never), ReadStatus::kAbsent);
}

TEST_F(Reader, ExpiresWhenTheZoneGoesWhileItIsRead) {
  zones->put(1, pack().chunks());
  EXPECT_EQ(reader.read(1, [&](const ZoneSignatures&) { zones->remove(1); }), ReadStatus::kExpired);
}

TEST_F(Reader, ExpiresWhenTheSameZoneWasLoadedAgainMeanwhile) {
  zones->put(1, pack().chunks());
  EXPECT_EQ(reader.read(1,
                        [&](const ZoneSignatures&) {
                          zones->remove(1);
                          zones->put(1, pack().chunks());
                        }),
            ReadStatus::kExpired);
  EXPECT_EQ(reader.read(1, [](const ZoneSignatures&) {}), ReadStatus::kOk);
}

TEST_F(Reader, ExpiresWhenANewZonedTakesTheMemoryOver) {
  zones->put(1, pack().chunks());
  EXPECT_EQ(
      reader.read(
          1, [&](const ZoneSignatures&) { const SharedZones next(memory.bytes(), 2, slots + 1); }),
      ReadStatus::kExpired);
}

TEST_F(Reader, ReadsAnotherZoneAndForgetsItsOwnInTheMiddle) {
  zones->put(1, pack().chunks());
  EXPECT_EQ(reader.read(1,
                        [&](const ZoneSignatures& z) {
                          EXPECT_EQ(reader.read(0, [](const ZoneSignatures&) {}),
                                    ReadStatus::kAbsent);
                          reader.forget_grants();
                          expect_same(z, pack().view());
                        }),
            ReadStatus::kOk);
}

TEST(Overstay, StaysInsideTheSlotsWhateverIsWrittenThere) {
  // The zone's slots stand apart; reading one byte outside them crashes.
  const DecodedPack& pack = sample_map();
  const std::uint32_t slots = 2 * SharedZones::slots_for(pack.chunks());
  auto memory = SharedMemory::create("zonepack-test", shared_map_bytes(1, slots)).value();
  SharedZones zones(memory.bytes(), 1, slots);
  zones.leave_gaps();
  zones.put(0, pack.chunks());
  auto mapped = SharedMemory::map_read_only(memory.reader_file().value()).value();
  auto reader = SharedReader::open(mapped.read_only()).value();
  std::vector<SlotIndex> own;
  for (SlotIndex s = zones.chain(0).head; s != kNoSlot; s = zones.next(s)) {
    own.push_back(s);
    std::byte* const gap = const_cast<std::byte*>(mapped.read_only().data()) +
                           shared_places(1, slots).slots + std::size_t{s + 1} * kSlotBytes;
    ASSERT_EQ(mprotect(gap, kSlotBytes, PROT_NONE), 0);
  }
  std::mt19937_64 engine(7);
  const auto overwrite = [&](int round) {
    for (const SlotIndex s : own) {
      for (std::byte& byte : zones.map().slot(s)) {
        byte = round < 2 ? std::byte(round * 0xFF) : static_cast<std::byte>(engine());
      }
    }
  };
  EXPECT_EQ(reader.read(0,
                        [&](const ZoneSignatures& z) {
                          for (int round = 0; round < 5; ++round) {
                            overwrite(round);
                            for (std::uint32_t i = 0; i < z.size(); ++i) {
                              const auto record = test_support::record_from(z[i]);
                              EXPECT_EQ(record.id, pack.view().core(i).signature->id());
                            }
                          }
                          zones.remove(0);
                        }),
            ReadStatus::kExpired);
}

TEST_F(Reader, RefusesWhatNoSoundWriterWrites) {
  const auto never = [](const ZoneSignatures&) { FAIL(); };
  std::mt19937_64 engine(3);
  std::size_t damaged = 0;
  for (int round = 0; round < 200; ++round) {
    zones->put(1, pack().chunks());
    const SlotChain chain = zones->chain(1);
    switch (round % 4) {
      case 0:  // a link to nowhere
        zones->map().links()[chain.head] = slots + 1 + static_cast<SlotIndex>(engine() % 1000);
        break;
      case 1:  // a chain in a ring: chunks twice
        zones->map().links()[chain.head] = chain.head;
        break;
      case 2:  // a chunk past the end of its slot
        zones->map().chunks(chain.head)[0] = {0, 200, 16000};
        break;
      default:  // chunks that are not where the table says
        zones->map().chunks(chain.head)[0].offset_lines =
            static_cast<std::uint8_t>(1 + engine() % 9);
    }
    damaged += reader.read(1, never) == ReadStatus::kDamaged;
    zones.emplace(memory.bytes(), 2, slots + 1);
  }
  EXPECT_EQ(damaged, 200u);
}

TEST_F(Reader, RefusesMemoryThatIsNotLaidOutForIt) {
  std::vector<std::byte> copy(mapped.read_only().begin(), mapped.read_only().end());
  EXPECT_EQ(SharedReader::open(std::span(copy).first(64)).error().code, ErrorCode::kTruncated);
  EXPECT_EQ(SharedReader::open(std::span(copy).first(copy.size() - 1)).error().code,
            ErrorCode::kMismatch);
  reinterpret_cast<SharedHeader*>(copy.data())->version = 2;
  EXPECT_EQ(SharedReader::open(copy).error(), (Error{ErrorCode::kBadVersion, 2}));
  copy[0] = std::byte{0};
  EXPECT_EQ(SharedReader::open(copy).error().code, ErrorCode::kBadMagic);
}

TEST(SampleMap, IsReadThroughTheClientAsByThePacker) {
  const DecodedPack& pack = sample_map();
  const std::uint32_t slots = SharedZones::slots_for(pack.chunks());
  auto memory = SharedMemory::create("zonepack-test", shared_map_bytes(1, slots)).value();
  SharedZones zones(memory.bytes(), 1, slots);
  zones.put(0, pack.chunks());
  auto reader = SharedReader::open(memory.read_only()).value();
  EXPECT_EQ(reader.read(0, [&](const ZoneSignatures& z) { expect_same(z, pack.view()); }),
            ReadStatus::kOk);
}

}  // namespace
}  // namespace zonepack
