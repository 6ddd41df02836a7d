// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/output_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace zonepack {
namespace {

using testing::HasSubstr;

TEST(OutputCheck, NamesEveryOutputThatCannotBeWritten) {
  const test_support::TemporaryFolder folder;
  const std::string good = folder / "events.jsonl", no = folder / "no", nowhere = no + "/run.json";
  const std::string taken = folder / "";
  const auto checked =
      check_outputs({{"--events", good, true}, {"--json", nowhere, true}, {"--report", taken}});
  ASSERT_FALSE(checked);
  EXPECT_EQ(exit_code(checked.error()), 1);
  EXPECT_THAT(checked.error().message,
              HasSubstr("--json: " + nowhere + ": cannot be written: there is no folder " + no +
                        "; mkdir -p " + no));
  EXPECT_THAT(checked.error().message, HasSubstr("--report: " + taken + ": cannot be written"));
  EXPECT_THAT(checked.error().message, testing::Not(HasSubstr("--events")));
}

TEST(OutputCheck, TakesDevicesAndPipesWithoutOpeningThem) {
  const test_support::TemporaryFolder folder;
  const std::string pipe = folder / "pipe", null = "/dev/null";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_TRUE(check_outputs({{"--record-can", pipe}, {"--json", null, true}}));
}

TEST(OutputCheck, GivesStandardOutputToOneOnly) {
  const std::string output = "-";
  EXPECT_TRUE(check_outputs({{"--events", output, true}}));
  const auto both = check_outputs({{"--events", output, true}, {"--json", output, true}});
  ASSERT_FALSE(both);
  EXPECT_EQ(exit_code(both.error()), 2);
  EXPECT_THAT(both.error().message, HasSubstr("--events - and --json -"));
}

// As a user whom permissions bind: root may write everything.
int failures_of(const OutputChoice& output) {
  constexpr uid_t kNobody = 65534;
  if (::geteuid() == 0 && ::setuid(kNobody) != 0) return 2;
  return check_outputs({output}) ? 0 : 1;
}

TEST(OutputCheck, AsksForTheFolderOfAFileThatIsReplacedAndForTheFileThatIsWrittenInPlace) {
  const test_support::TemporaryFolder folder;
  const std::string file = folder / "live.jsonl";
  std::ofstream(file) << "of another run\n";
  ASSERT_EQ(chmod(file.c_str(), 0444), 0);
  ASSERT_EQ(chmod((folder / "").c_str(), 0777), 0);
  const OutputChoice replaced{"--events", file, true};
  const OutputChoice in_place{"--record-can", file, false, Overwriting::kInPlace};
  EXPECT_EXIT(std::_Exit(failures_of(replaced)), testing::ExitedWithCode(0), "");
  EXPECT_EXIT(std::_Exit(failures_of(in_place)), testing::ExitedWithCode(1), "");
  ASSERT_EQ(chmod((folder / "").c_str(), 0555), 0);
  EXPECT_EXIT(std::_Exit(failures_of(replaced)), testing::ExitedWithCode(1), "");
}

}  // namespace
}  // namespace zonepack
