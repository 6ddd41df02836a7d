// SPDX-License-Identifier: Apache-2.0
// What `zonepack build` prints when it fails, and what it leaves behind.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>

#include "tests/system/build/packer_program.hpp"

namespace zonepack::system_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(BuildUsage, ExitsWith2AndNamesTheOption) {
  const Packer packer;
  packer.write_database(four_signatures());
  const std::pair<std::string, std::string> cases[] = {
      {"build --zones zones.geojson --out map", "--db"},
      {"build --db map.db --out map", "--zones"},
      {"build --db map.db --zones zones.geojson", "--out"},
      {"build --db map.db --zones zones.geojson --out map --payload features,smells", "smells"},
      {"build --db map.db --zones zones.geojson --out map --payload features,", "payload"},
      {"build --db map.db --zones zones.geojson --out map --orphans keep",
       "--orphans: 'keep' is none of nearest, drop, error"},
      {"build --db map.db --zones zones.geojson --out map --unlinked guess", "--unlinked"},
      {"build --db map.db --zones zones.geojson --out map --damaged mend", "--damaged"},
      {"build --db map.db --zones zones.geojson --out map --jobs 0", "--jobs"},
      {"build --db map.db --zones zones.geojson --out map --snap far", "--snap"},
      {"build --db map.db --zones zones.geojson --out map --snap -1", "--snap"},
      {"build --db map.db --zones zones.geojson --out map --max-zone-bytes 3Mb", "3Mb"},
      {"build --db map.db --zones zones.geojson --out map --colour red", "--colour"},
      {"plan map --budget many", "many"},
      {"plan", "DIR"},
      {"pack", "pack"},
      {"", "subcommand"}};
  for (const auto& [arguments, word] : cases) {
    const Outcome outcome = packer.zonepack(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments << "\n" << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr(word)) << arguments;
  }
  EXPECT_FALSE(std::filesystem::exists(packer.path("map")));
}

TEST(BuildErrors, NameTheFileThatCannotBeRead) {
  const Packer packer;
  EXPECT_THAT(packer.build().output, HasSubstr("map.db"));
  EXPECT_EQ(packer.build().exit_code, 1);
  packer.write("map.db", "");
  EXPECT_EQ(packer.build().exit_code, 1);
  packer.write("map.db", std::string(4096, 'x'));
  const Outcome noise = packer.build();
  EXPECT_EQ(noise.exit_code, 1);
  EXPECT_THAT(noise.output, HasSubstr("map.db: "));
  packer.write_database(four_signatures());
  packer.write("zones.geojson", "{");
  const Outcome zones = packer.build();
  EXPECT_EQ(zones.exit_code, 1);
  EXPECT_THAT(zones.output, HasSubstr("zones.geojson"));
  std::filesystem::remove(packer.path("zones.geojson"));
  const Outcome missing = packer.build();
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.output, HasSubstr("zones.geojson"));
}

TEST(BuildErrors, RefuseADatabaseThatIsOpenElsewhere) {
  const Packer packer;
  packer.write_database(four_signatures());
  packer.write("map.db-wal", std::string(64, 'w'));
  const Outcome outcome = packer.build();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("map.db"), HasSubstr("wal")));
}

TEST(Build, LeavesTheDatabaseAsItWas) {
  const Packer packer;
  packer.write_database(test_support::one_of_everything("0.23.8"));
  const std::string before = bytes_of_file(packer.path("map.db"));
  struct stat then {};
  ASSERT_EQ(::stat(packer.path("map.db").c_str(), &then), 0);
  packer.build_summary();
  struct stat now {};
  ASSERT_EQ(::stat(packer.path("map.db").c_str(), &now), 0);
  EXPECT_EQ(now.st_mtim.tv_sec, then.st_mtim.tv_sec);
  EXPECT_EQ(now.st_mtim.tv_nsec, then.st_mtim.tv_nsec);
  EXPECT_EQ(now.st_ino, then.st_ino);
  EXPECT_TRUE(bytes_of_file(packer.path("map.db")) == before);
  for (const auto& entry : std::filesystem::directory_iterator(packer.path("."))) {
    const std::string name = entry.path().filename();
    EXPECT_TRUE(name == "map.db" || !name.starts_with("map.db")) << name;
  }
}

TEST(BuildErrors, SayWhenTheFolderCannotBeMade) {
  const Packer packer;
  packer.write_database(four_signatures());
  packer.write("map", "a file in the way");
  const Outcome outcome = packer.build();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("map: "), HasSubstr("--out")));
  EXPECT_EQ(bytes_of_file(packer.path("map")), "a file in the way");
}

// A limit on file size stands in for a full disk: writing fails in the middle of a pack.
TEST(BuildErrors, LeaveTheOldMapWhenTheDiskIsFull) {
  const Packer packer;
  packer.write_database(four_signatures());
  packer.build_summary();
  const std::string before = packer.zonepack("export map --jsonl").output;
  packer.write_database(test_support::one_of_everything("0.23.8"));
  const Outcome outcome = run("cd " + packer.path("").string() +
                              " && (trap '' XFSZ; ulimit -f 8; " ZONEPACK_PROGRAM
                              " build --db map.db --zones zones.geojson --out map) 2>&1");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.output;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("map: cannot write a pack"), HasSubstr("room")));
  EXPECT_EQ(packer.zonepack("export map --jsonl").output, before);
  for (const auto& entry : std::filesystem::directory_iterator(packer.path("map"))) {
    EXPECT_THAT(entry.path().filename(), ::testing::Not(HasSubstr(".part-")));
  }
}

TEST(Build, PutsJsonAloneOnStandardOutput) {
  const Packer packer;
  packer.write_database(four_signatures());
  const Outcome outcome =
      run("cd " + packer.path("").string() +
          " && " ZONEPACK_PROGRAM
          " build --db map.db --zones zones.geojson --out map --json - 2>/dev/null");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(nlohmann::json::parse(outcome.output)["signatures"], 4);
}

TEST(MapErrors, NameWhatIsMissing) {
  const Packer packer;
  for (const char* command : {"export nowhere --jsonl", "plan nowhere"}) {
    const Outcome outcome = packer.zonepack(command);
    EXPECT_EQ(outcome.exit_code, 1) << command;
    EXPECT_THAT(outcome.output, HasSubstr("nowhere/manifest.zpm: not found")) << command;
  }
  packer.write_database(four_signatures());
  packer.build_summary();
  const Outcome zone = packer.zonepack("export map --zone attic --jsonl");
  EXPECT_EQ(zone.exit_code, 1);
  EXPECT_THAT(zone.output, HasSubstr("no zone 'attic' in this map; it has east, west\n"));
  EXPECT_THAT(packer.zonepack("plan map --pin weast").output,
              HasSubstr("it has east, west; did you mean 'east'?"));
}

// One line, so that a long run does not come first.
TEST(OutputPaths, AreRefusedBeforeAnythingIsRead) {
  const Packer packer;  // without map.db: reading it would be the first error
  packer.write("file", "");
  for (const char* arguments :
       {"build --db map.db --zones zones.geojson --out file/map",
        "build --db map.db --zones zones.geojson --out map --json none/summary.json",
        "check-zones nowhere.geojson --out none/preview.svg", "outline --db map.db --out file",
        "report nowhere --out none/map.html", "export nowhere --out none/map.jsonl",
        "export nowhere --out .", "plan nowhere --json none/plan.json",
        "verify nowhere --json none/verdict.json", "prune nowhere --json none/prune.json"}) {
    const Outcome outcome = packer.zonepack(arguments);
    EXPECT_EQ(outcome.exit_code, 1) << arguments;
    EXPECT_THAT(outcome.output, ::testing::ContainsRegex("cannot (be written|create the folder)"))
        << arguments;
    EXPECT_EQ(std::ranges::count(outcome.output, '\n'), 1) << outcome.output;
  }
  EXPECT_FALSE(std::filesystem::exists(packer.path("map")));
}

TEST(Options, MayStandBeforeTheSubcommand) {
  const Packer packer;
  packer.write_database(four_signatures());
  EXPECT_EQ(packer.zonepack("--db map.db --zones=zones.geojson --out map build").exit_code, 0);
  // The value of an option names no subcommand.
  EXPECT_EQ(packer.zonepack("--json plan plan map").exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(packer.path("plan")));
  EXPECT_THAT(packer.zonepack("--dry-run prune map").output, HasSubstr("0 files"));
  EXPECT_EQ(packer.zonepack("plan --version").exit_code, 0);
}

TEST(Inspect, TakesSeveralPathsAndKeepsTheJsonOfOne) {
  const Packer packer;
  packer.write_database(four_signatures());
  packer.build_summary();
  const Outcome both = packer.zonepack("inspect map map/*.zpk --json all.json");
  EXPECT_EQ(both.exit_code, 0) << both.output;
  const auto all = nlohmann::json::parse(bytes_of_file(packer.path("all.json")));
  ASSERT_EQ(all.size(), 3u);  // the map, east and west
  EXPECT_EQ(all[1]["zone"], "east");
  packer.zonepack("inspect map --json one.json");
  EXPECT_EQ(nlohmann::json::parse(bytes_of_file(packer.path("one.json"))), all[0]);
}

TEST(Build, SaysWhatPruneWouldRemove) {
  const Packer packer;
  packer.write_database(four_signatures());
  EXPECT_EQ(packer.build_summary()["prunable_files"], 0);
  const Outcome again = packer.build("--payload features --json summary.json");
  EXPECT_THAT(again.output, HasSubstr("zonepack prune map\n"));
  const auto summary = nlohmann::json::parse(bytes_of_file(packer.path("summary.json")));
  const std::size_t files = summary["prunable_files"];
  EXPECT_GT(files, 0u);
  const Outcome pruned = packer.zonepack("prune map --json pruned.json");
  const auto json = nlohmann::json::parse(bytes_of_file(packer.path("pruned.json")));
  EXPECT_EQ(json["files"].size(), files);
  EXPECT_EQ(json["bytes"], summary["prunable_bytes"]);
}

TEST(Plan, ExitsWith1BelowTheSmallestBudget) {
  const Packer packer;
  packer.write_database(four_signatures());
  const std::uint64_t smallest = packer.build_summary()["smallest_budget_bytes"];
  EXPECT_EQ(packer.zonepack("plan map --budget " + std::to_string(smallest)).exit_code, 0);
  const Outcome below = packer.zonepack("plan map --budget " + std::to_string(smallest - 1));
  EXPECT_EQ(below.exit_code, 1);
  EXPECT_THAT(below.output, HasSubstr("BELOW THE SMALLEST by 1 byte:"));
}

}  // namespace
}  // namespace zonepack::system_test
