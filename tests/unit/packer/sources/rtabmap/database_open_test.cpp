// SPDX-License-Identifier: Apache-2.0
// Anything but a closed RTAB-Map database is refused with a reason; the file itself never changes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "packer/sources/rtabmap/rtabmap_database.hpp"
#include "tests/support/blob_writer.hpp"
#include "tests/support/rtabmap_fixture.hpp"
#include "tests/support/signature_recipe.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

namespace fs = std::filesystem;
using test_support::execute;
using test_support::one_of_everything;
using test_support::write_rtabmap_database;
using ::testing::HasSubstr;

std::string contents(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

class OpeningADatabase : public ::testing::Test {
 protected:
  std::string refusal(const fs::path& path) {
    try {
      RtabmapDatabase database(path);
    } catch (const SqliteError& error) {
      EXPECT_THAT(error.what(), ::testing::StartsWith(path.string() + ": "));
      return error.what();
    }
    return "not refused";
  }

  test_support::TemporaryFolder folder_;
  fs::path path_ = folder_ / "map.db";
};

TEST_F(OpeningADatabase, CallsWhatStandsInForADatabaseByItsName) {
  write(path_, "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 5\n");
  EXPECT_THAT(refusal(path_),
              HasSubstr("a Git LFS pointer, not the file itself; run: git lfs pull"));
  write(path_, std::string("\x1F\x8B\x08") + std::string(40, 'x'));
  EXPECT_THAT(refusal(path_), HasSubstr("compressed by gzip; run gunzip"));
  write(path_, "PK\x03\x04" + std::string(40, 'x'));
  EXPECT_THAT(refusal(path_), HasSubstr("a ZIP archive; run unzip"));
}

// No byte of the database is locked, so another program may write to it.
TEST_F(OpeningADatabase, AWriteWhileItIsReadIsNoticed) {
  write_rtabmap_database(path_, one_of_everything("0.23.8"));
  const RtabmapDatabase database(path_);
  EXPECT_NO_THROW(database.require_unchanged());
  EXPECT_NO_THROW(database.reopen());
  const fs::path journal = path_.string() + "-journal";
  const auto refused = [&] {
    try {
      database.reopen();
    } catch (const SqliteError& error) {
      return std::string(error.what());
    }
    return std::string("not refused");
  };
  write(journal, "an unfinished commit");
  EXPECT_THAT(refused(), HasSubstr("a write to it was interrupted"));
  EXPECT_THROW(database.require_unchanged(), SqliteError);
  fs::remove(journal);
  EXPECT_NO_THROW(database.require_unchanged());
  execute(path_, "UPDATE Node SET stamp = stamp + 1");
  EXPECT_THAT(refused(), HasSubstr("changed while it was read; close RTAB-Map"));
}

TEST_F(OpeningADatabase, AWriteAheadLogThatAppearsWhileItIsReadIsNoticed) {
  write_rtabmap_database(path_, one_of_everything("0.23.8"));
  execute(path_, "PRAGMA journal_mode=WAL");
  const std::string before = contents(path_);
  const RtabmapDatabase database(path_);
  EXPECT_NO_THROW(database.require_unchanged());
  sqlite3* writer = nullptr;
  ASSERT_EQ(sqlite3_open(path_.c_str(), &writer), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(writer, "UPDATE Node SET stamp = stamp + 1", nullptr, nullptr, nullptr),
            SQLITE_OK);
  ASSERT_EQ(contents(path_), before);  // the change is in the log alone
  try {
    database.require_unchanged();
    ADD_FAILURE() << "the log was not seen";
  } catch (const SqliteCorrupt&) {
    ADD_FAILURE() << "a file that is written is not a damaged one";
  } catch (const SqliteError& error) {
    EXPECT_THAT(error.what(), HasSubstr("changed while it was read; close RTAB-Map"));
  }
  EXPECT_THROW(database.reopen(), SqliteError);
  sqlite3_close(writer);
}

TEST_F(OpeningADatabase, RefusesWhatIsNotThereOrNotAFile) {
  EXPECT_THAT(refusal(path_), HasSubstr("no such file"));
  EXPECT_THAT(refusal(folder_.path()), HasSubstr("is a folder"));
  write(path_, "");
  EXPECT_THAT(refusal(path_), HasSubstr("is empty"));
  write(path_, "x");
  EXPECT_THAT(refusal(path_), HasSubstr("is not a SQLite database"));
  write(path_, std::string(5000, 'x'));
  EXPECT_THAT(refusal(path_), HasSubstr("is not a SQLite database"));
  EXPECT_THAT(refusal("/dev/null"), HasSubstr("is not a regular file"));
}

TEST_F(OpeningADatabase, RefusesAnotherKindOfDatabase) {
  execute(path_, "CREATE TABLE keyframes (id INTEGER)");
  EXPECT_THAT(refusal(path_), HasSubstr("is not an RTAB-Map database"));
}

TEST_F(OpeningADatabase, RefusesADatabaseThatIsStillBeingWritten) {
  write_rtabmap_database(path_, one_of_everything("0.23.8"));
  write(folder_ / "map.db-wal", "frames");
  EXPECT_THAT(refusal(path_), HasSubstr("wal_checkpoint(TRUNCATE)"));
  write(folder_ / "map.db-wal", "");  // left behind empty: nothing is missing from the file
  EXPECT_EQ(refusal(path_), "not refused");
  write(folder_ / "map.db-journal", std::string(512, '\xd9'));
  EXPECT_THAT(refusal(path_), HasSubstr("was interrupted"));
  write(folder_ / "map.db-journal", std::string(512, '\0'));  // a finished one, as PERSIST keeps it
  EXPECT_EQ(refusal(path_), "not refused");
}

TEST_F(OpeningADatabase, RefusesALiveWriteAheadLog) {
  write_rtabmap_database(path_, one_of_everything("0.23.8"));
  sqlite3* writer = nullptr;
  ASSERT_EQ(sqlite3_open(path_.c_str(), &writer), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(writer, "PRAGMA journal_mode=WAL; UPDATE Node SET weight=2 WHERE id=1",
                         nullptr, nullptr, nullptr),
            SQLITE_OK);
  EXPECT_THAT(refusal(path_), HasSubstr("close RTAB-Map"));
  sqlite3_close(writer);  // folds the log into the file
  RtabmapDatabase database(path_);
  EXPECT_EQ(database.read(1, PayloadSet()).weight, 2);
}

TEST_F(OpeningADatabase, LooksForTheLogNextToTheFileAndNotNextToALinkToIt) {
  write_rtabmap_database(path_, one_of_everything("0.23.8"));
  const fs::path link = folder_ / "link.db";
  fs::create_symlink(path_, link);
  EXPECT_EQ(RtabmapDatabase(link).outline().nodes.size(), 23u);
  write(folder_ / "map.db-wal", "frames");
  EXPECT_THAT(refusal(link), HasSubstr("map.db-wal"));
}

TEST_F(OpeningADatabase, ChangesNeitherBytesNorTimesNorFolder) {
  write_rtabmap_database(path_, one_of_everything("0.23.8"));
  execute(path_, "PRAGMA journal_mode=WAL");
  const std::string before = contents(path_);
  const auto modified = fs::last_write_time(path_);
  const auto folder_modified = fs::last_write_time(folder_.path());
  {
    RtabmapDatabase database(path_);
    const std::unique_ptr<MapSource> second = database.reopen();
    for (const NodeOutline& node : database.outline().nodes) {
      database.read(node.id, PayloadSet());
      second->read(node.id, PayloadSet());
    }
  }
  EXPECT_EQ(contents(path_), before);
  EXPECT_EQ(fs::last_write_time(path_), modified);
  EXPECT_EQ(fs::last_write_time(folder_.path()), folder_modified);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1);
}

TEST_F(OpeningADatabase, GivesEachThreadItsOwnReader) {
  const auto fixture = one_of_everything("0.23.8");
  write_rtabmap_database(path_, fixture);
  const auto expected = test_support::expected_records(fixture);
  const RtabmapDatabase database(path_);
  std::atomic<int> equal = 0;
  const auto read_all = [&] {
    const std::unique_ptr<MapSource> own = database.reopen();
    for (const SignatureRecord& wanted : expected) {
      const SignatureRecord record = own->read(wanted.id, PayloadSet());
      if (test_support::first_difference(record, wanted).empty()) ++equal;
    }
  };
  std::vector<std::jthread> threads;
  for (int i = 0; i < 3; ++i) threads.emplace_back(read_all);
  threads.clear();
  EXPECT_EQ(equal, 3 * 23);
}

TEST_F(OpeningADatabase, TakesAnyFileName) {
  const fs::path odd = folder_ / "50% of ward #3?mode=rwc&x=\xc3\xa9 '\".db";
  write_rtabmap_database(odd, one_of_everything("0.23.8"));
  EXPECT_EQ(RtabmapDatabase(odd).outline().nodes.size(), 23u);
  const fs::path before = fs::current_path();
  fs::current_path(folder_.path());
  EXPECT_EQ(RtabmapDatabase(odd.filename()).outline().nodes.size(), 23u);
  fs::current_path(before);
}

TEST_F(OpeningADatabase, RefusesVersionsThatNobodyCanRead) {
  write_rtabmap_database(path_, one_of_everything("0.23.8"));
  execute(path_, "UPDATE Admin SET version='0.10.9'");
  EXPECT_THAT(refusal(path_), HasSubstr("rtabmap-reprocess"));
  for (const char* version : {"", "0", "abc", "0.x", "0.23.8.1", "0.23.", "0.-1.0"}) {
    execute(path_, std::string("UPDATE Admin SET version='") + version + "'");
    EXPECT_THAT(refusal(path_), HasSubstr("Admin.version is '" + std::string(version) + "'"));
  }
  execute(path_, "DELETE FROM Admin");
  EXPECT_THAT(refusal(path_), HasSubstr("Admin.version"));
}

TEST_F(OpeningADatabase, ReadsANewerVersionWithAWarningWhileItsColumnsAreThere) {
  write_rtabmap_database(path_, one_of_everything("0.23.8"));
  execute(path_, "UPDATE Admin SET version='0.25.1'");
  execute(path_, "ALTER TABLE Feature ADD COLUMN novelty FLOAT");
  RtabmapDatabase database(path_);
  ASSERT_EQ(database.outline().warnings.size(), 1u);
  EXPECT_THAT(database.outline().warnings[0], HasSubstr("newer than 0.23"));
  EXPECT_EQ(database.read(1, PayloadSet()).features.count, 20u);
  execute(path_, "ALTER TABLE Data RENAME COLUMN scan TO laser");
  EXPECT_THAT(refusal(path_), HasSubstr("has no column Data.scan any more"));
}

TEST_F(OpeningADatabase, AcceptsTwoPartVersionsAndOtherSpellingOfColumns) {
  write_rtabmap_database(path_, one_of_everything("0.23.8"));
  execute(path_, "UPDATE Admin SET version='0.23'");
  execute(path_, "ALTER TABLE Data RENAME COLUMN scan TO Scan");
  RtabmapDatabase database(path_);
  EXPECT_EQ(database.outline().schema_version, "0.23.0");
  EXPECT_TRUE(database.read(1, PayloadSet()).scan.has_value());
}

TEST_F(OpeningADatabase, NamesASignatureThatIsNotThere) {
  write_rtabmap_database(path_, one_of_everything("0.23.8"));
  RtabmapDatabase database(path_);
  EXPECT_THROW(database.read(99, PayloadSet()), SqliteError);
  EXPECT_THROW(database.read(22, PayloadSet()), SqliteError);  // deleted
}

}  // namespace
}  // namespace zonepack::packer
