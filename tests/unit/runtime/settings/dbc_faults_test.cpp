// SPDX-License-Identifier: Apache-2.0
// DBC files that are not as they should be.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "runtime/settings/dbc_file.hpp"
#include "tests/unit/runtime/settings/dbc_text.hpp"

namespace zonepack {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing_support::fault_of;
using testing_support::find;
using testing_support::message;
using testing_support::parse;
using testing_support::slips_and_faults;

TEST(DbcFile, FaultsNameLineColumnAndWhatWasExpected) {
  struct Case {
    std::string text;
    const char* fault;
  };
  for (const Case& c : {
           Case{"BO_ 0x64 M: 8 N\n", "a.dbc:1:5: expected the message's id, a whole number"},
           Case{"\n\n  BOO_ 1 M: 8 N\n", "a.dbc:3:3: expected a statement such as BO_, SG_"},
           Case{"BO_ 1 M 8 N\n", "a.dbc:1:9: expected ':', found '8'"},
           Case{"SG_ S : 0|8@1+ (1,0) [0|0] \"\" N\n",
                "a.dbc:1:1: expected a message (BO_) before"},
           Case{message(" SG_ S 0|8@1+ (1,0) [0|0] \"\" N"), "a.dbc:2:8: expected ':', found '0'"},
           Case{message(" SG_ S : 0|8@2+ (1,0) [0|0] \"\" N"),
                "a.dbc:2:14: expected the byte order"},
           Case{message(" SG_ S : 0|8@1 (1,0) [0|0] \"\" N"), "a.dbc:2:16: expected + (unsigned)"},
           Case{message(" SG_ S : 0|8@1+ (x,0) [0|0] \"\" N"), "a.dbc:2:18: expected the factor"},
           Case{message(" SG_ S : 0|8@1+ (1,0) [0|0] N"), "a.dbc:2:29: expected the unit"},
           Case{message(" SG_ S q : 0|8@1+ (1,0) [0|0] \"\" N"), "a.dbc:2:8: expected M, m and"},
           Case{message(" SG_ S m : 0|8@1+ (1,0) [0|0] \"\" N"),
                "a.dbc:2:8: expected a number after the multiplexer mark m, found 'm'"},
           Case{"BO_ 1 M: 8\n", "a.dbc:2:1: expected the sender's name"},
           Case{message(" SG_ S mM : 0|8@1+ (1,0) [0|0] \"\" N"), "a.dbc:2:8: expected M, m and"},
           Case{message(" SG_ S : 0|8@1+ (1,0) [0|0] \"rad"),
                "a.dbc:2:29: expected a quote at the end of the text that begins here"},
           Case{"CM_ \"a\"\nBA_ \"b\" 1;",
                "a.dbc:2:1: expected ';' at the end of the CM_ of line 1"},
           Case{"CM_ \"a\"",
                "a.dbc:1:8: expected ';' at the end of the CM_ of line 1, found the end"},
           Case{"SIG_VALTYPE_ 1 S : 3;", "a.dbc:1:20: expected 0 (integer), 1 (float) or 2"},
           Case{"SG_MUL_VAL_ 1 S M 1;", "a.dbc:1:20: expected '-', found ';'"},
           Case{"BA_ \"GenMsgCycleTime\" BO_ 1 x;", "a.dbc:1:29: expected the cycle time in ms"},
       }) {
    EXPECT_THAT(slips_and_faults(c.text), ElementsAre(HasSubstr(c.fault))) << c.text;
  }
}

TEST(DbcFile, ContinuesAfterASlipAndLists20) {
  EXPECT_THAT(parse("BO_ x\nBO_ 1 A: 8 N\n SG_ S\n SG_ T : 0|8@1+ (1,0) [0|0] \"\" N\n"
                    "BO_ y\n")
                  .slips,
              ElementsAre(HasSubstr("a.dbc:1:5"), HasSubstr("a.dbc:4:2"), HasSubstr("a.dbc:5:5")));
  std::string many;
  for (int i = 0; i < 100; ++i) many += "BO_ x\n";
  const LoadedDbc loaded = parse(many);
  ASSERT_THAT(loaded.faults, SizeIs(21));
  EXPECT_THAT(loaded.faults.back(), HasSubstr("a.dbc: 80 more of the same kind"));
}

const std::string kGood = "BO_ 7 Good: 8 N\n SG_ S : 0|8@1+ (2,0) [0|0] \"\" N\n";

// Each slip costs its own statement: the good message after it is read.
TEST(DbcFile, ASlipInAStatementThatIsNotReadIsAWarning) {
  for (const std::string text : {
           "NEW_ 1 2 x ;\n",
           "!!\n",
           "CM_ \"no semicolon\"\n",
           "VAL_ 1 S 0 \"off\"\n",
           "BO_ 0x64 M: 8 N\n SG_ S : 0|8@1+ (1,0) [0|0] \"\" N\n",
           "BO_ 1 M: 8\n",
           "BO_ 1 M: 8 N\n SG_ S m : 0|8@1+ (1,0) [0|0] \"\" N\n",
           "BO_ 1 M: 8 N\n SG_ S : 0|8@1+ [0|0] \"\" N\n",
           "BA_ \"GenMsgCycleTime\" BO_ 1 x;\n",
       }) {
    for (const std::string& file : {text + kGood, kGood + text}) {
      const LoadedDbc loaded = parse(file);
      EXPECT_THAT(loaded.faults, IsEmpty()) << file;
      EXPECT_THAT(loaded.slips, SizeIs(1)) << file;
      EXPECT_EQ(find(loaded, "Good.S").signal.factor, 2) << file;
    }
  }
}

TEST(DbcFile, ASlipInWhatIsReadIsAFault) {
  const LoadedDbc loaded =
      parse(message(" SG_ X M : 0|8@1+ [0|0] \"\" N\n SG_ Y m1 : 8|8@1+ (1,0) [0|0] \"\" N\n"
                    " SG_ Z m : 8|8@1+ (1,0) [0|0] \"\" N\n SG_ W M : 0|8@1+ (1,0) [0|0] \"\" N"));
  EXPECT_THAT(fault_of(loaded, "M.X"), HasSubstr("a.dbc:2:2: M.X cannot be read: a.dbc:2:19: exp"));
  EXPECT_THAT(fault_of(loaded, "M.Y"), HasSubstr("multiplexer"));
  EXPECT_THAT(fault_of(loaded, "M.Z"), HasSubstr("multiplexer"));
  // These may change how any signal is read.
  EXPECT_THAT(parse(kGood + "SIG_VALTYPE_ 7 S : x;\n").faults, SizeIs(1));
  EXPECT_THAT(parse(kGood + "SG_MUL_VAL_ 7 S X 1;\n").faults, SizeIs(1));
  EXPECT_THAT(parse(kGood + "CM_ \"never closed;\n").faults, SizeIs(1));
}

TEST(DbcFile, ABareMultiplexerMarkNeedsItsValues) {
  const std::string bare =
      message(" SG_ X M : 0|8@1+ (1,0) [0|0] \"\" N\n SG_ Z m : 8|8@1+ (1,0) [0|0] \"\" N");
  EXPECT_THAT(fault_of(parse(bare), "M.Z"), HasSubstr("its multiplexer mark m has no number"));
  const LoadedDbc with_values = parse(bare + "SG_MUL_VAL_ 100 Z X 3-3;\n");
  EXPECT_EQ(find(with_values, "M.Z").signal.levels, 1);
}

TEST(DbcFile, CommentsRunToTheEndOfTheirLineOutsideOfTexts) {
  const LoadedDbc loaded = parse(
      "// BO_ 1 No: 8 N\nBO_ 100 M: 8 N // the wheels\n SG_ S : 0|8@1+ (1,0) [0|0] \"m//s\" N //"
      "\n// the end");
  EXPECT_THAT(slips_and_faults("// only this"), IsEmpty());
  EXPECT_THAT(loaded.slips, IsEmpty());
  ASSERT_THAT(loaded.file.messages(), SizeIs(1));
  EXPECT_EQ(find(loaded, "M.S").unit, "m//s");
}

TEST(DbcFile, ARangeMayBeAnything) {
  for (const char* range :
       {"-1e400|1E+400", "0|1e-400", "nan|inf", "-1.#INF|1.#INF", "|", "a b|-"}) {
    const LoadedDbc loaded =
        parse(message(" SG_ S : 0|8@1+ (1,0) [" + std::string(range) + "] \"m\" N"));
    EXPECT_THAT(loaded.slips, IsEmpty()) << range;
    EXPECT_EQ(find(loaded, "M.S").unit, "m") << range;
  }
  EXPECT_EQ(
      parse(message(" SG_ S : 0|8@1+ (1,0) [0|1e400] \"\" N")).file.messages()[0].signals[0].most,
      std::numeric_limits<double>::infinity());
  // What is read must be right.
  EXPECT_THAT(fault_of(parse(message(" SG_ S : 0|8@1+ (1e400,0) [0|1] \"\" N")), "M.S"),
              HasSubstr("its factor or offset is not a finite number"));
}

TEST(DbcFile, AnUnknownNameIsReportedWithTheNearest) {
  const LoadedDbc loaded = load_dbc(ZONEPACK_SOURCE_DIR "/config/agilex.dbc");
  EXPECT_THAT(
      fault_of(loaded, "Odometri.LeftWheel"),
      HasSubstr("agilex.dbc: no message Odometri; did you mean \"Odometry\"? Known: Motion"));
  EXPECT_THAT(fault_of(loaded, "Odometry.LeftWeel"),
              HasSubstr("Odometry has no signal LeftWeel; did you mean \"LeftWheel\"? Known: "
                        "LeftWheel, RightWheel"));
  EXPECT_THAT(fault_of(loaded, "Odometry"),
              HasSubstr("Odometry is a message; expected MESSAGE.SIGNAL"));
  const LoadedDbc twice = parse(message(" SG_ S : 0|8@1+ (1,0) [0|0] \"\" N\n"
                                        " SG_ S : 8|8@1+ (1,0) [0|0] \"\" N") +
                                "BO_ 5 D: 8 N\nBO_ 6 D: 8 N\n");
  EXPECT_THAT(fault_of(twice, "M.S"), HasSubstr("a.dbc:1: lines 2 and 3 both define S"));
  EXPECT_THAT(fault_of(twice, "D.S"), HasSubstr("lines 4 and 5 both define a message D"));
}

TEST(DbcFile, ASignalThatDoesNotFitIsAFaultOnlyWhenItIsAskedFor) {
  const LoadedDbc loaded = parse(
      message(" SG_ Good : 0|8@1+ (1,0) [0|0] \"\" N\n SG_ Far : 60|8@1+ (1,0) [0|0] \"\" N\n"
              " SG_ Long : 0|65@1+ (1,0) [0|0] \"\" N\n SG_ None : 0|0@1+ (1,0) [0|0] \"\" N\n"
              " SG_ Zero : 0|8@1+ (0,0) [0|0] \"\" N"));
  EXPECT_THAT(loaded.faults, IsEmpty());
  EXPECT_EQ(find(loaded, "M.Good").signal.bits.length, 8);
  EXPECT_THAT(
      fault_of(loaded, "M.Far"),
      HasSubstr("a.dbc:3:2: M.Far cannot be read: its bits need 9 bytes, the message has 8"));
  EXPECT_THAT(fault_of(loaded, "M.Long"), HasSubstr("expected 1 to 64 bits"));
  EXPECT_THAT(fault_of(loaded, "M.None"), HasSubstr("expected 1 to 64 bits"));
  EXPECT_THAT(fault_of(loaded, "M.Zero"), HasSubstr("its factor is 0"));
}

TEST(DbcFile, FilesThatAreMissingOrTooLargeAreRefused) {
  EXPECT_THAT(load_dbc("/no/such.dbc").faults,
              ElementsAre(HasSubstr("/no/such.dbc: cannot be read: No such file")));
  EXPECT_FALSE(load_dbc(testing::TempDir()).ok());
  EXPECT_THAT(parse(std::string(kLargestDbc + 1, ' ')).faults,
              ElementsAre(HasSubstr("over 4 MiB")));
  std::string many = "BO_ 1 M: 8 N\n";
  for (std::size_t i = 0; i < kMostDbcSignals + 1; ++i) many += "SG_ S:0|8@1+(1,0)[0|0]\"\"\n";
  EXPECT_THAT(parse(many).faults, ElementsAre(HasSubstr("expected at most 65536 signals")));
}

}  // namespace
}  // namespace zonepack
