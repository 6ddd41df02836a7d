// SPDX-License-Identifier: Apache-2.0
// A database made to harm: nothing of it runs, no statement goes on for ever, no value is too long.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "damaged_signatures.hpp"
#include "packer/sources/rtabmap/rtabmap_database.hpp"
#include "packer/sources/sqlite/sqlite.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

using test_support::execute;
using ::testing::HasSubstr;

class HostileDatabase : public ::testing::Test {
 protected:
  HostileDatabase() { write_rtabmap_database(path_, three_signatures()); }

  std::string refusal() {
    try {
      RtabmapDatabase database(path_);
    } catch (const SqliteError& error) {
      return error.what();
    }
    return "not refused";
  }

  test_support::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "map.db";
};

TEST_F(HostileDatabase, DoesNotRunAViewInPlaceOfATable) {
  execute(path_, "ALTER TABLE Link RENAME TO Real");
  execute(path_, "CREATE VIEW link AS SELECT * FROM Real");
  EXPECT_THAT(refusal(), HasSubstr("map.db: Link is a view, which is never run"));
}

TEST_F(HostileDatabase, DoesNotRunAVirtualTable) {
  execute(path_, "DROP TABLE Feature");
  execute(path_, "CREATE VIRTUAL TABLE Feature USING fts5(node_id, word_id)");
  EXPECT_THAT(refusal(), HasSubstr("map.db: Feature is a virtual table, which is never run"));
}

TEST_F(HostileDatabase, DoesNotComputeAGeneratedColumn) {
  execute(path_, "DROP INDEX IDX_node_label");
  execute(path_, "ALTER TABLE Node DROP COLUMN label");
  execute(path_, "ALTER TABLE Node ADD COLUMN label TEXT AS ('computed')");
  RtabmapDatabase database(path_);
  EXPECT_EQ(database.outline().nodes[0].label, "");
}

TEST_F(HostileDatabase, IsReadWhenOtherViewsAndTriggersStandBesideTheTables) {
  execute(path_, "CREATE VIEW Bad AS SELECT * FROM Nowhere");
  execute(path_, "CREATE TRIGGER Node AFTER INSERT ON Node BEGIN SELECT 1; END");
  EXPECT_EQ(refusal(), "not refused");
}

TEST_F(HostileDatabase, CannotMakeThisProgramCallFunctionsOrWrite) {
  const SqliteFile file(path_);
  for (const char* sql : {"SELECT load_extension('x')", "PRAGMA writable_schema=ON",
                          "ATTACH ':memory:' AS other", "CREATE TEMP TABLE t (a)",
                          "WITH RECURSIVE r(n) AS (SELECT 1 UNION ALL SELECT n+1 FROM r) "
                          "SELECT n FROM r"}) {
    EXPECT_THROW(SqliteQuery(file, sql), SqliteError) << sql;
  }
}

// Eight factors of 60 features make 1.7e14 rows; the file has about 100 KB.
TEST_F(HostileDatabase, DoesNotHoldTheProgramInAStatementWithoutEnd) {
  const auto start = std::chrono::steady_clock::now();
  const SqliteFile file(path_);
  SqliteQuery query(file,
                    "SELECT sum(1) FROM Feature a, Feature b, Feature c, Feature d, Feature e, "
                    "Feature f, Feature g, Feature h");
  try {
    query.step();
    FAIL() << "counted 60^8 rows";
  } catch (const SqliteCorrupt& error) {
    EXPECT_THAT(error.what(), HasSubstr("expected a statement to end within "));
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

TEST_F(HostileDatabase, HasAllStatementsTogetherBounded) {
  const SqliteFile file(path_);
  SqliteQuery query(file, "SELECT sum(1) FROM Feature a, Feature b, Feature c");  // 216,000 rows
  std::string refusal;
  for (int i = 0; i < 10'000 && refusal.empty(); ++i) {
    query.restart();
    try {
      query.step();
    } catch (const SqliteError& error) {
      refusal = error.what();
    }
  }
  EXPECT_THAT(refusal, HasSubstr("reading it took more than "));
}

TEST_F(HostileDatabase, HasOnlyTheSignatureOfAnOverlongValueDamaged) {
  const std::string label(kLargestPlainValueBytes + 1, 'x');
  execute(path_, "UPDATE Node SET label='" + label + "' WHERE id=2");
  RtabmapDatabase database(path_);
  ASSERT_EQ(database.outline().nodes.size(), 3u);
  ASSERT_EQ(database.outline().damages.size(), 1u);
  EXPECT_EQ(database.outline().damages[0].signature, 2);
  EXPECT_EQ(database.outline().damages[0].problem,
            "expected values of at most 1048576 bytes, found a longer one");
  EXPECT_THROW(database.read(2, PayloadSet()), DamagedSignature);
  EXPECT_EQ(database.read(3, PayloadSet()).links.size(), 1u);
}

// Allowed in SQLite, but a value of a feature that no reader expects.
TEST_F(HostileDatabase, HasOnlyTheSignatureOfAnOverlongDescriptorDamaged) {
  execute(path_, "UPDATE Feature SET descriptor=zeroblob(1048577) WHERE node_id=2");
  RtabmapDatabase database(path_);
  EXPECT_EQ(database.read(1, PayloadSet()).links.size(), 1u);
  EXPECT_THROW(database.read(2, PayloadSet()), DamagedSignature);
}

TEST_F(HostileDatabase, HasARowWithAnIdBeyondInt32CountedAsDamaged) {
  execute(path_, "UPDATE Node SET id=5000000000 WHERE id=2");
  RtabmapDatabase database(path_);
  ASSERT_EQ(database.outline().damages.size(), 1u);
  EXPECT_EQ(database.outline().damages[0].column, "Node.id");
  EXPECT_THAT(database.outline().damages[0].problem, HasSubstr("holds '5000000000', expected"));
  EXPECT_EQ(database.outline().nodes.size(), 2u);
}

}  // namespace
}  // namespace zonepack::packer
