// SPDX-License-Identifier: Apache-2.0
// Every row of the table of limits, against packer, verify and robot.
#include "runtime/pack_format/limits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "packer/build/manifest_writer.hpp"
#include "packer/encode/format_limit.hpp"
#include "packer/encode/packable.hpp"
#include "packer/verify/map_verifier.hpp"
#include "runtime/map/load_fault.hpp"
#include "runtime/map/loader.hpp"
#include "tests/support/hostile_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack {

void PrintTo(const Limit& row, std::ostream* out) { *out << row.name; }

namespace {

using test_support::map_that_measures;
using test_support::MemoryFolder;
using test_support::TemporaryFolder;

// A file of a length, which takes no room on the disk, with bytes at its end.
void write_sparse(const std::filesystem::path& path, std::uint64_t size, ByteSpan front,
                  ByteSpan end) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(front.data()),
             static_cast<std::streamsize>(front.size()));
  file.seekp(static_cast<std::streamoff>(size - end.size()));
  file.write(reinterpret_cast<const char*>(end.data()), static_cast<std::streamsize>(end.size()));
}

// A map whose manifest, or whose only pack's index, is so long.
void write_long_file(const std::filesystem::path& folder, LimitId id, std::uint64_t found) {
  if (id == LimitId::kManifestBytes) {
    ManifestTail tail;
    write_sparse(folder / std::string(kManifestName), found + kManifestFrameBytes, {},
                 std::as_bytes(std::span(&tail, 1)));
    return;
  }
  MemoryFolder map = map_that_measures(LimitId::kVerticesOfZone, 4);
  for (const auto& [name, bytes] : map.files) test_support::write_bytes(folder / name, bytes);
  const PackHeader header;
  PackTail tail;
  tail.index_offset = sizeof header;
  tail.index_size = found;
  write_sparse(folder / "z.zpk", sizeof header + found + sizeof tail,
               std::as_bytes(std::span(&header, 1)), std::as_bytes(std::span(&tail, 1)));
}

bool of_a_long_file(const Limit& row) {
  return row.id == LimitId::kManifestBytes || row.id == LimitId::kIndexBytes;
}
bool is_stated(const Limit& row) { return row.id != LimitId::kChunksOfSlot; }

class LimitRow : public testing::TestWithParam<Limit> {
 protected:
  const Limit& row() const { return GetParam(); }
  // Of rows that one zone breaks: the refusal names it.
  bool names_zone() const {
    switch (row().id) {
      case LimitId::kZones:
      case LimitId::kPortals:
      case LimitId::kPayloadKinds:
      case LimitId::kManifestBytes:
      case LimitId::kNameBytes:  // not fit to be printed: its entry is named
        return false;
      default:
        return true;
    }
  }
  std::string refusal(std::uint64_t found) const { return to_string(Excess{row().id, found}); }

  void write_map(std::uint64_t found) {
    if (of_a_long_file(row())) return write_long_file(folder_.path(), row().id, found);
    for (const auto& [name, bytes] : map_that_measures(row().id, found).files) {
      test_support::write_bytes(folder_ / name, bytes);
    }
  }

  // All that the robot says of the map: at start, and when it loads the zone.
  std::string robot() {
    const auto catalog = Catalog::open(folder_.path().string(), kEveryPayload);
    if (!catalog) return catalog.error().message;
    std::vector<std::byte> slot(2 * kSlotBytes), buffer(kReadBufferBytes);
    void* place = slot.data();
    std::size_t room = slot.size();
    std::byte* aligned = static_cast<std::byte*>(std::align(64, kSlotBytes, place, room));
    Error error;
    auto load = ZoneLoad::begin(*catalog, 0, {&aligned, 1}, buffer, ReadMode::kCached);
    if (!load) {
      error = load.error();
    } else {
      Result<bool> more = true;
      while (more && *more) more = load->step();
      error = more.error();
    }
    return error.code == ErrorCode::kOk ? "" : load_fault(*catalog, 0, error);
  }

  std::string verify() {
    std::string all;
    for (const packer::Problem& problem :
         packer::verify_map(packer::FolderFiles(folder_.path())).problems) {
      all += packer::to_string(problem) + "\n";
    }
    return all;
  }

  // What the packer says of a map with so many; empty when it would pack it.
  std::string packer_of(std::uint64_t found) {
    packer::ZonePlan plan;
    std::vector<packer::PackSummary> packs(1);
    packs[0].file = "z.zpk";
    packs[0].slots = {0};
    plan.zones.resize(1);
    plan.zones[0].name = "z000000";
    plan.zones[0].polygon.outer = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};
    switch (row().id) {
      case LimitId::kZones:
        plan.zones.resize(found);
        break;
      case LimitId::kPortals:
        plan.portals.resize(found);
        break;
      case LimitId::kPortalsOfZone:
        plan.zones.push_back(plan.zones[0]);
        plan.zones[1].name = "z000001";
        packs.push_back(packs[0]);
        plan.portals.resize(found);
        for (auto& portal : plan.portals) portal.zone_b = 1;
        break;
      case LimitId::kVerticesOfZone:
        plan.zones[0].polygon.outer.resize(found);
        break;
      case LimitId::kNameBytes:
        plan.zones[0].name = std::string(static_cast<std::size_t>(found), 'n');
        break;
      case LimitId::kSignaturesOfZone:
        packs[0].signatures = static_cast<std::uint32_t>(found);
        break;
      case LimitId::kChunksOfPack:
        packs[0].payloads[0].chunks = static_cast<std::uint32_t>(found);
        break;
      case LimitId::kCoreBlobBytes: {
        packer::SignatureRecord record;
        record.label = std::string(static_cast<std::size_t>(found), 'l');
        const auto unpackable = packer::find_unpackable(record);
        return unpackable ? unpackable->problem : "";
      }
      default:
        try {
          packer::require_within(row().id, found);
        } catch (const std::runtime_error& error) {
          return error.what();
        }
        return "";
    }
    packer::ManifestContent content;
    content.plan = &plan;
    content.packs = &packs;
    content.nodes.resize(plan.zones.size());
    content.payload = kCoreOnly;
    try {
      packer::manifest_bytes(content);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  TemporaryFolder folder_;
};

// The rows that each of them refuses beyond, and those that a file can state or reach: a file of
// half a gigabyte at its limit would only take long to read.
class PackersLimit : public LimitRow {};
class VerifysLimit : public LimitRow {};
class RobotsLimit : public LimitRow {};
class ReachedLimit : public LimitRow {};
class UnwatchedLimit : public LimitRow {};

TEST_P(LimitRow, SaysWhoRefusesWhatIsBeyondAndWhyOthersNeedNot) {
  int refusing = 0;
  for (const Holding& who : {row().packer, row().verify, row().robot}) {
    if (who.refuses()) {
      ++refusing;
    } else {
      EXPECT_GT(std::string(who.exempt).size(), 20u);
    }
  }
  EXPECT_TRUE(refusing > 0 || !is_stated(row()));
}

TEST_P(PackersLimit, IsRefusedByName) {
  EXPECT_NE(packer_of(row().most + 1).find(refusal(row().most + 1)), std::string::npos)
      << packer_of(row().most + 1);
  // Zones and portals at their limit would take minutes to write.
  if (row().id == LimitId::kZones || row().id == LimitId::kPortals) return;
  if (row().id == LimitId::kSignaturesOfZone) return;  // and a node for each signature
  EXPECT_EQ(packer_of(row().most), "");
}

TEST_P(VerifysLimit, IsRefusedWithFileZoneValueAndLimit) {
  write_map(row().most + 1);
  const std::string said = verify();
  EXPECT_NE(said.find(refusal(row().most + 1)), std::string::npos) << said;
  EXPECT_TRUE(said.starts_with("manifest.zpm: ") || said.starts_with("z.zpk: ")) << said;
  if (names_zone()) {
    EXPECT_NE(said.find("z000000"), std::string::npos) << said;
  }
}

TEST_P(RobotsLimit, IsRefusedWithZoneValueAndLimit) {
  write_map(row().most + 1);
  const std::string said = robot();
  EXPECT_NE(said.find(refusal(row().most + 1)), std::string::npos) << said;
  if (names_zone()) {
    EXPECT_NE(said.find("z000000"), std::string::npos) << said;
  }
}

TEST_P(ReachedLimit, IsNoReasonForARefusal) {
  write_map(row().most);
  EXPECT_EQ(verify().find(std::string(row().name) + ": "), std::string::npos) << verify();
  EXPECT_EQ(robot().find(std::string(row().name) + ": "), std::string::npos) << robot();
}

// The three that say they need not look: nothing the robot does with it is beyond.
TEST_P(UnwatchedLimit, HarmsNoRobot) {
  write_map(row().most + 1);
  EXPECT_EQ(robot(), "");
}

TEST_P(LimitRow, StandsInTheDocumentOfTheFormat) {
  const auto with_commas = [](std::uint64_t value) {
    std::string text = std::to_string(value);
    for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, ",");
    return text;
  };
  std::string refused_by;
  const std::pair<const char*, Holding> all[] = {
      {"packer", row().packer}, {"verify", row().verify}, {"robot", row().robot}};
  for (const auto& [who, holding] : all) {
    if (holding.refuses()) refused_by += (refused_by.empty() ? "" : ", ") + std::string(who);
  }
  std::ostringstream text;
  text << std::ifstream(ZONEPACK_SOURCE_DIR "/runtime/pack_format/FORMAT.md").rdbuf();
  const std::string line = std::string("| ") + row().name + " | " + with_commas(row().most) +
                           " | " + (refused_by.empty() ? "-" : refused_by) + " | ";
  EXPECT_NE(text.str().find(line), std::string::npos) << line;
}

std::string test_name(const testing::TestParamInfo<Limit>& test) {
  std::string name = test.param.name;
  std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
  return name;
}

auto rows_that(bool (*wanted)(const Limit& row)) {
  std::vector<Limit> rows;
  std::ranges::copy_if(kLimits, std::back_inserter(rows), wanted);
  return testing::ValuesIn(rows);
}

INSTANTIATE_TEST_SUITE_P(Rows, LimitRow, testing::ValuesIn(kLimits), test_name);
INSTANTIATE_TEST_SUITE_P(Rows, PackersLimit,
                         rows_that([](const Limit& row) { return row.packer.refuses(); }),
                         test_name);
INSTANTIATE_TEST_SUITE_P(Rows, VerifysLimit,
                         rows_that([](const Limit& row) { return row.verify.refuses(); }),
                         test_name);
INSTANTIATE_TEST_SUITE_P(Rows, RobotsLimit,
                         rows_that([](const Limit& row) { return row.robot.refuses(); }),
                         test_name);
INSTANTIATE_TEST_SUITE_P(Rows, ReachedLimit, rows_that([](const Limit& row) {
                           return is_stated(row) && !of_a_long_file(row);
                         }),
                         test_name);
INSTANTIATE_TEST_SUITE_P(Rows, UnwatchedLimit, rows_that([](const Limit& row) {
                           return is_stated(row) && !row.robot.refuses();
                         }),
                         test_name);

// By hand: 4097 is row 10 (vertices of a zone) and 4097, -1 - (10 * 2^48 + 4097).
TEST(OverLimit, CarriesRowAndValueInADetailBelowZero) {
  const Error error = over_limit(LimitId::kVerticesOfZone, 4097);
  EXPECT_EQ(error, (Error{ErrorCode::kTooLarge, -1 - ((std::int64_t{10} << 48) + 4097)}));
  EXPECT_EQ(excess_of(error)->id, LimitId::kVerticesOfZone);
  EXPECT_EQ(to_string(*excess_of(error)),
            "vertices of a zone: 4097, the format holds at most 4096");
  EXPECT_FALSE(excess_of({ErrorCode::kTooLarge, 4097}));  // a need of bytes
  EXPECT_FALSE(excess_of({ErrorCode::kBadValue, -5}));
}

}  // namespace
}  // namespace zonepack
