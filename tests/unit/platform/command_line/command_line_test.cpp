// SPDX-License-Identifier: Apache-2.0
#include "platform/command_line/command_line.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace zonepack {
namespace {

// A program with an option and a flag, and two subcommands: run (--speed N, --json [FILE]) and
// stop (PLACE).
struct Program {
  std::string socket, speed, json, place;
  bool loud = false;
  std::string command;

  void parse(std::vector<const char*> words) {
    CLI::App app("a program", "program");
    app.require_subcommand(0, 1);
    app.add_option("--socket", socket);
    app.add_flag("--loud", loud);
    CLI::App& run = *app.add_subcommand("run", "goes on");
    run.add_option("--speed", speed);
    run.add_option_function<std::string>(
           "--json", [this](const std::string& file) { json = file.empty() ? "-" : file; })
        ->expected(0, 1);
    CLI::App& stop = *app.add_subcommand("stop", "does not");
    stop.add_option("PLACE", place)->required();
    words.insert(words.begin(), "program");
    parse_command_line(app, static_cast<int>(words.size()), words.data());
    for (const CLI::App* const used : app.get_subcommands()) command = used->get_name();
  }
};

TEST(CommandLine, TakesOptionsBeforeAndAfterTheSubcommand) {
  for (const std::vector<const char*>& words :
       {std::vector<const char*>{"--socket", "S", "--speed", "3", "--loud", "run"},
        {"run", "--socket", "S", "--speed", "3", "--loud"},
        {"--speed=3", "run", "--loud", "--socket=S"}}) {
    Program program;
    program.parse(words);
    EXPECT_EQ(program.command, "run");
    EXPECT_EQ(program.socket, "S");
    EXPECT_EQ(program.speed, "3");
    EXPECT_TRUE(program.loud);
  }
}

TEST(CommandLine, TakesAWordForAValueWhereAnOptionNeedsOne) {
  Program program;
  program.parse({"--socket", "run", "stop", "here"});
  EXPECT_EQ(program.socket, "run");
  EXPECT_EQ(program.command, "stop");
  EXPECT_EQ(program.place, "here");
}

TEST(CommandLine, TakesASubcommandForNoValueThatMayBeLeftOut) {
  Program bare, with_file;
  bare.parse({"--json", "run"});
  EXPECT_EQ(bare.command, "run");
  EXPECT_EQ(bare.json, "-");
  with_file.parse({"--json", "out.json", "run"});
  EXPECT_EQ(with_file.json, "out.json");
}

TEST(CommandLine, RefusesWhatNoneOfThemKnows) {
  Program program;
  EXPECT_THROW(program.parse({"run", "--fast"}), CLI::ParseError);
  EXPECT_THROW(program.parse({"--fast", "run"}), CLI::ParseError);
}

std::string refusal_of(const std::vector<const char*>& words) {
  Program program;
  try {
    program.parse(words);
  } catch (const CLI::ParseError& error) {
    return error.what();
  }
  return "";
}

TEST(CommandLine, NamesTheNearestOfWhatItKnows) {
  EXPECT_EQ(refusal_of({"rum"}), "unknown command \"rum\"; did you mean \"run\"? Known: run, stop");
  EXPECT_EQ(refusal_of({"--loud", "--socket", "S", "walk"}),
            "unknown command \"walk\"; known: run, stop");
  EXPECT_EQ(refusal_of({"run", "--spede", "3"}),
            "unknown option --spede of run; did you mean --speed?");
  EXPECT_EQ(refusal_of({"run", "--spede=3"}),
            "unknown option --spede of run; did you mean --speed?");
  EXPECT_EQ(refusal_of({"--sokcet", "S", "run"}),
            "unknown option --sokcet of run; did you mean --socket?");
  EXPECT_EQ(refusal_of({"--sokcet", "S"}), "unknown option --sokcet; did you mean --socket?");
  // Before it misses PLACE.
  EXPECT_EQ(refusal_of({"stop", "--xylophone"}), "unknown option --xylophone of stop");
}

TEST(CommandLine, HelpsWhoeverAsks) {
  for (const char* const help : {"--help", "-h"}) {
    Program program;
    EXPECT_THROW(program.parse({"rum", "--sokcet", help}), CLI::CallForHelp);
  }
}

TEST(CommandLine, TakesNoValueForAnUnknownWord) {
  EXPECT_EQ(refusal_of({"run", "--speed", "--sokcet"}), "");
  EXPECT_EQ(refusal_of({"--speed", "-3", "run"}), "");
  EXPECT_EQ(refusal_of({"stop", "--", "--here"}), "");
}

TEST(CommandLine, EndsHelpWithExamples) {
  CLI::App app("a program", "program");
  add_examples(app, {"program run", "program run \\\n  --speed 3"});
  EXPECT_NE(app.help().find("Examples:\n  program run\n  program run \\\n    --speed 3"),
            std::string::npos)
      << app.help();
}

}  // namespace
}  // namespace zonepack
