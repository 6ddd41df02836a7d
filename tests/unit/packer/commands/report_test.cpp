// SPDX-License-Identifier: Apache-2.0
#include "packer/commands/report.hpp"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include "packer/build/map_builder.hpp"
#include "packer/decode/map_reader.hpp"
#include "packer/inspect/map_plan.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

namespace fs = std::filesystem;

// The sample hospital, packed once for all tests.
class ReportCommandTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test_support::TemporaryFolder>();
    BuildOptions options;
    options.source = fs::path(ZONEPACK_TEST_DATA) / "hospital-small.db";
    options.zones = fs::path(ZONEPACK_TEST_DATA) / "zones.geojson";
    options.out = *folder_ / "map";
    std::ostringstream quiet;
    Progress progress(quiet, false);
    built_ = build_map(options, progress);
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static std::string map() { return (*folder_ / "map").string(); }

  static std::string problem_of(const std::string& folder) {
    try {
      read_pack_report(folder);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  static inline std::unique_ptr<test_support::TemporaryFolder> folder_;
  static inline BuildSummary built_;
};

TEST_F(ReportCommandTest, CountsWhatTheBuildCounted) {
  const report::PackReport read = read_pack_report(map());
  ASSERT_EQ(read.zones.size(), 24u);
  EXPECT_EQ(read.portals.size(), 28u);
  ByteCount charged = 0, stored = 0;
  std::uint64_t signatures = 0, features = 0;
  for (const report::PackedZone& zone : read.zones) {
    charged += zone.charged_bytes;
    stored += zone.stored_bytes;
    signatures += zone.signatures;
    features += zone.features;
    EXPECT_EQ(zone.signature_positions.size(), zone.signatures) << zone.name;
  }
  EXPECT_EQ(charged, built_.charged_bytes);
  EXPECT_EQ(stored, built_.stored_bytes);
  EXPECT_EQ(signatures, 185u);
  EXPECT_EQ(features, built_.features);
  EXPECT_EQ(read.smallest_budget_bytes, built_.smallest.bytes);
  EXPECT_EQ(read.payload, "features, scan, grid");
}

TEST_F(ReportCommandTest, CountsThePayloadAskedForAsPlanDoes) {
  const MapReader built(map());
  // Images were not packed: they are left out.
  for (const PayloadMask payload : {kCoreOnly, kCoreOnly | mask_of(fb::PayloadKind::Features),
                                    kDefaultPayload | mask_of(fb::PayloadKind::Image)}) {
    const report::PackReport read = read_pack_report(map(), payload);
    const MapPlan plan =
        plan_map(built.manifest(), payload & built.manifest().payload_mask(), {}, std::nullopt);
    EXPECT_EQ(read.smallest_budget_bytes, plan.smallest.bytes);
    ASSERT_EQ(read.zones.size(), plan.zones.size());
    for (std::size_t i = 0; i < read.zones.size(); ++i) {
      EXPECT_EQ(read.zones[i].charged_bytes, plan.zones[i].charged_bytes) << read.zones[i].name;
      EXPECT_EQ(read.zones[i].stored_bytes, plan.zones[i].stored_bytes) << read.zones[i].name;
    }
  }
  EXPECT_EQ(read_pack_report(map(), kCoreOnly).payload, "poses only");
  EXPECT_LT(read_pack_report(map(), kCoreOnly).zones[0].charged_bytes,
            read_pack_report(map()).zones[0].charged_bytes);
}

TEST_F(ReportCommandTest, KnowsWhereEverySignatureStands) {
  const report::PackReport read = read_pack_report(map());
  std::size_t inside = 0;
  for (const report::PackedZone& zone : read.zones) {
    for (const Point2& p : zone.signature_positions) {
      inside += side_of(zone.polygon, p) != Side::kOutside ? 1 : 0;
    }
  }
  EXPECT_EQ(inside, 185 - built_.orphans.size());
}

TEST_F(ReportCommandTest, WritesThePageAndSaysSoByItsExitCode) {
  CLI::App app;
  int exit_code = 7;
  add_report_command(app, exit_code);
  const std::string out = (*folder_ / "report.html").string();
  app.parse(
      std::vector<std::string>{out, "--out", map(), "report"});  // CLI11 takes them in reverse
  EXPECT_EQ(exit_code, 0);
  std::ostringstream text;
  text << std::ifstream(out).rdbuf();
  EXPECT_NE(text.str().find(">main lobby with nurses station and waiting areas<"),
            std::string::npos);
}

TEST_F(ReportCommandTest, RefusesAnotherKindOfFileByItsName) {
  CLI::App app;
  int exit_code = 7;
  add_report_command(app, exit_code);
  const std::string out = (*folder_ / "report.pdf").string();
  EXPECT_THROW(app.parse(std::vector<std::string>{out, "--out", map(), "report"}),
               CLI::ValidationError);
  EXPECT_EQ(exit_code, 7);
}

TEST_F(ReportCommandTest, NamesAManifestThatIsMissingOrDamaged) {
  const std::string missing = (*folder_ / "none").string();
  EXPECT_EQ(problem_of(missing),
            missing + "/manifest.zpm: not found; is this a map that 'zonepack build' wrote?");
  const fs::path damaged = *folder_ / "damaged";
  fs::create_directory(damaged);
  fs::copy_file(fs::path(map()) / "manifest.zpm", damaged / "manifest.zpm");
  std::fstream file(damaged / "manifest.zpm", std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(1000);
  file.put('\xA5');
  file.close();
  const std::string problem = problem_of(damaged.string());
  EXPECT_NE(problem.find("bad checksum"), std::string::npos) << problem;
  EXPECT_NE(problem.find("zonepack verify"), std::string::npos) << problem;
}

}  // namespace
}  // namespace zonepack::packer
