// SPDX-License-Identifier: Apache-2.0
#include "platform/process/run_program.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <string>

namespace zonepack {
namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File scratch() { return {std::tmpfile(), &std::fclose}; }

TEST(RunProgram, PassesArgumentsAsTheyAreAndConnectsInputAndOutput) {
  const File in = scratch(), out = scratch();
  ASSERT_EQ(::pwrite(fileno(in.get()), "zone", 4, 0), 4);
  const Result<int> status = run_program({"cat", "-"}, fileno(in.get()), fileno(out.get()));
  ASSERT_TRUE(status.ok());
  EXPECT_EQ(*status, 0);
  char text[8] = {};
  EXPECT_EQ(::pread(fileno(out.get()), text, sizeof(text), 0), 4);
  EXPECT_STREQ(text, "zone");
}

TEST(RunProgram, DoesNotExpandArguments) {
  const File in = scratch(), out = scratch();
  ASSERT_TRUE(run_program({"echo", "$HOME;", "a b"}, fileno(in.get()), fileno(out.get())).ok());
  char text[32] = {};
  ASSERT_GT(::pread(fileno(out.get()), text, sizeof(text), 0), 0);
  EXPECT_STREQ(text, "$HOME; a b\n");
}

TEST(RunProgram, TellsExitStatusSignalAndMissingProgramApart) {
  const File in = scratch(), out = scratch();
  const auto run = [&](std::vector<std::string> arguments) {
    return run_program(arguments, fileno(in.get()), fileno(out.get()));
  };
  EXPECT_EQ(*run({"sh", "-c", "exit 7"}), 7);
  EXPECT_EQ(*run({"sh", "-c", "kill -9 $$"}), 128 + 9);
  EXPECT_EQ(run({"no-such-program-zonepack"}).error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace zonepack
