// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "damaged_signatures.hpp"
#include "packer/sources/rtabmap/rtabmap_database.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

using test_support::execute;
using test_support::first_difference;
using test_support::RtabmapFixture;
using ::testing::HasSubstr;

TEST(Damage, OfPayloadsThatAreNotWantedIsNotMet) {
  const test_support::TemporaryFolder folder;
  const auto path = folder / "map.db";
  write_rtabmap_database(path, three_signatures());
  execute(path, "UPDATE Data SET image=?1, depth=?1, scan=?1 WHERE id=2", Bytes(30, std::byte{1}));
  RtabmapDatabase database(path);
  const PayloadSet wanted{.scan = false, .image = false, .depth = false};
  EXPECT_EQ(database.read(2, wanted).features.count, 20u);
}

TEST(Damage, OfNodeRowsAndPosesIsInTheOutline) {
  const test_support::TemporaryFolder folder;
  const auto path = folder / "map.db";
  RtabmapFixture fixture = three_signatures();
  (*fixture.signatures[2].pose)[3] = kNan;
  write_rtabmap_database(path, fixture);
  execute(path, "UPDATE Node SET pose=?1 WHERE id=1", numbers(3));
  const MapOutline outline = RtabmapDatabase(path).outline();
  ASSERT_EQ(outline.damages.size(), 2u);
  EXPECT_EQ(outline.damages[0].signature, 1);
  EXPECT_EQ(outline.damages[0].column, "Node.pose");
  EXPECT_EQ(outline.damages[1].signature, 3);
  EXPECT_EQ(outline.damages[1].column, "Admin.opt_poses");
  EXPECT_TRUE(outline.find(1)->damaged);
  EXPECT_FALSE(outline.find(2)->damaged);
  EXPECT_EQ(outline.unlinked(), 0u);  // damaged is not unlinked
  EXPECT_THROW(RtabmapDatabase(path).read(3, PayloadSet()), DamagedSignature);
}

TEST(Damage, OfADeletedNodeDoesNotMatter) {
  const test_support::TemporaryFolder folder;
  const auto path = folder / "map.db";
  write_rtabmap_database(path, three_signatures());
  execute(path, "UPDATE Node SET weight=-9, pose=?1 WHERE id=2", numbers(3));
  const MapOutline outline = RtabmapDatabase(path).outline();
  EXPECT_TRUE(outline.damages.empty());
  EXPECT_EQ(outline.deleted_nodes, 1u);
}

TEST(Damage, RowsOfOneSignatureInTwoAreFound) {
  const test_support::TemporaryFolder folder;
  const auto path = folder / "map.db";
  write_rtabmap_database(path, three_signatures());
  execute(path,
          "CREATE TABLE copy AS SELECT * FROM Data; DROP TABLE Data; ALTER TABLE copy RENAME TO "
          "Data; INSERT INTO Data SELECT * FROM Data WHERE id=2");
  RtabmapDatabase database(path);
  EXPECT_THROW(database.read(2, PayloadSet()), DamagedSignature);
  EXPECT_EQ(first_difference(database.read(3, PayloadSet()), three_signatures().signatures[2]), "");

  execute(path,
          "CREATE TABLE copy AS SELECT * FROM Node; DROP TABLE Node; ALTER TABLE copy RENAME TO "
          "Node; INSERT INTO Node SELECT * FROM Node WHERE id=3");
  const RtabmapDatabase doubled(path);
  ASSERT_EQ(doubled.outline().damages.size(), 1u);
  EXPECT_EQ(doubled.outline().damages[0].column, "Node.id");
  EXPECT_EQ(doubled.outline().nodes.size(), 3u);
}

TEST(Damage, OfOldLayoutsIsFoundToo) {
  const test_support::TemporaryFolder folder;
  const auto path = folder / "map.db";
  write_rtabmap_database(path, three_signatures("0.17.6"));
  execute(path, "UPDATE Data SET scan_info=?1 WHERE id=1", numbers(16));
  execute(path, "UPDATE Data SET calibration=?1 WHERE id=2", numbers(20));
  execute(path, "UPDATE Data SET calibration=?1 WHERE id=3", numbers(36));
  RtabmapDatabase database(path);
  EXPECT_THROW(database.read(1, PayloadSet()), DamagedSignature);
  EXPECT_THROW(database.read(2, PayloadSet()), DamagedSignature);
  EXPECT_EQ(database.read(3, PayloadSet()).calibration.size(), 144u);

  write_rtabmap_database(path, three_signatures("0.11.13"));
  execute(path, "UPDATE Link SET rot_variance=0 WHERE from_id=1");
  EXPECT_THROW(RtabmapDatabase(path).read(1, PayloadSet()), DamagedSignature);
}

TEST(Damage, IsNotALaterLayoutUnderAnEarlierVersion) {
  const test_support::TemporaryFolder folder;
  const auto path = folder / "map.db";
  write_rtabmap_database(path, three_signatures());
  execute(path, "UPDATE Admin SET version='0.17.6'");
  RtabmapDatabase database(path);
  EXPECT_EQ(first_difference(database.read(2, PayloadSet()), three_signatures().signatures[1]), "");
}

// sqlite3 .dump saves nothing of such a file, so it is not advised.
TEST(Damage, OfTheListOfTablesLeavesNothingForSqlite3) {
  const test_support::TemporaryFolder folder;
  const auto path = folder / "map.db";
  write_rtabmap_database(path, three_signatures());
  {
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(100);  // the first page's tree, which lists the tables
    file << std::string(8, 'x');
  }
  try {
    const RtabmapDatabase database(path);
    FAIL() << "read without its list of tables";
  } catch (const SqliteError& error) {
    EXPECT_THAT(error.what(), HasSubstr("rtabmap-recovery"));
    EXPECT_THAT(error.what(), ::testing::Not(HasSubstr(".dump")));
  }
}

TEST(Damage, IsAPoseThatNoRobotCanHave) {
  const test_support::TemporaryFolder folder;
  const auto path = folder / "map.db";
  const auto damages_with = [&](auto change) {
    RtabmapFixture fixture = three_signatures();
    change(*fixture.signatures[1].pose);
    write_rtabmap_database(path, fixture);
    const RtabmapDatabase database(path);
    std::string found;
    for (const Damage& damage : database.outline().damages) {
      found += std::to_string(damage.signature) + " " + damage.column + ": " + damage.problem;
    }
    return found;
  };
  EXPECT_EQ(damages_with([](Transform&) {}), "");
  EXPECT_THAT(damages_with([](Transform& T) { T[3] = 3e38F; }),
              HasSubstr("2 Admin.opt_poses: expected a position within 10,000 km"));
  EXPECT_THAT(damages_with([](Transform& T) { T[0] *= 2; }), HasSubstr("expected a rotation"));
  EXPECT_THAT(damages_with([](Transform& T) { T[10] = -T[10]; }), HasSubstr("expected a rotation"));
}

TEST(Damage, OfOnePageOfTheFileSparesTheSignaturesElsewhere) {
  const test_support::TemporaryFolder folder;
  const auto path = folder / "map.db";
  const RtabmapFixture fixture = three_signatures();
  write_rtabmap_database(path, fixture);
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  const std::string bytes(std::istreambuf_iterator<char>(file), {});
  // The page that holds the last descriptor of signature 3.
  const Bytes& descriptors = fixture.signatures[2].features.descriptors;
  const std::string last(reinterpret_cast<const char*>(descriptors.data()) + 19 * 32, 32);
  constexpr std::size_t kPage = 4096;
  const std::size_t at = bytes.find(last);
  ASSERT_NE(at, std::string::npos);
  file.clear();
  file.seekp(static_cast<std::streamoff>(at / kPage * kPage));
  file << std::string(8, 'x');
  file.close();

  RtabmapDatabase database(path);
  EXPECT_EQ(first_difference(database.read(1, PayloadSet()), fixture.signatures[0]), "");
  std::string hint;
  try {
    database.read(3, PayloadSet());
    FAIL() << "read a damaged page";
  } catch (const DamagedSignature& error) {
    EXPECT_EQ(error.damage().signature, 3);
    EXPECT_EQ(error.damage().column, "database file");
    hint = error.what();
  }
  EXPECT_EQ(database.read(3, {.features = false}).links.size(), 1u);

  // The hint, typed: what it saves can be read, the whole signature included.
  const std::size_t from = hint.find("sqlite3 '");
  const std::size_t to = hint.find(" (RTAB-Map");
  ASSERT_TRUE(from != hint.npos && to != hint.npos) << hint;
  if (std::system("command -v sqlite3 >/dev/null") != 0) GTEST_SKIP() << "no sqlite3";
  const std::string typed =
      "cd '" + folder.path().string() + "' && " + hint.substr(from, to - from);
  ASSERT_EQ(std::system((typed + " 2>/dev/null").c_str()), 0) << typed;
  RtabmapDatabase saved(folder / "NEW.db");
  EXPECT_EQ(first_difference(saved.read(1, PayloadSet()), fixture.signatures[0]), "");
  EXPECT_EQ(saved.outline().nodes.size(), database.outline().nodes.size());
}

// RTAB-Map itself reads these columns into float32, whatever wrote them.
TEST(RtabmapDatabase, RoundsNumbersToFloat32AsRtabmapDoes) {
  const test_support::TemporaryFolder folder;
  const std::filesystem::path path = folder / "map.db";
  test_support::write_rtabmap_database(path, test_support::one_of_everything("0.23.8"));
  test_support::execute(path, "UPDATE Feature SET pos_x=0.1 WHERE node_id=2");
  test_support::execute(path, "UPDATE Data SET cell_size=0.05 WHERE id=2");
  RtabmapDatabase database(path);
  const SignatureRecord record = database.read(2, PayloadSet());
  EXPECT_EQ(record.features.x.front(), 0.1F);
  EXPECT_EQ(record.grid->cell_size, 0.05F);
}

}  // namespace
}  // namespace zonepack::packer
