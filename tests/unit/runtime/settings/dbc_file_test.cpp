// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/dbc_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/unit/runtime/settings/dbc_text.hpp"

namespace zonepack {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing_support::fault_of;
using testing_support::find;
using testing_support::frame;
using testing_support::message;
using testing_support::parse;

TEST(DbcFile, ReadsTheOdometersOfAnAgileX) {
  const LoadedDbc loaded = load_dbc(ZONEPACK_SOURCE_DIR "/config/agilex.dbc");
  EXPECT_THAT(loaded.faults, IsEmpty());
  const DbcFound left = find(loaded, "Odometry.LeftWheel");
  EXPECT_EQ(left.signal.id, 0x311u);
  EXPECT_FALSE(left.signal.extended);
  EXPECT_EQ(left.unit, "m");
  EXPECT_EQ(left.cycle_s, 0.02);
  // 0x40DB = 16603 mm.
  const auto reading = read_signal(left.signal, frame(0x311, {0, 0, 0x40, 0xDB, 0, 1, 0x5B, 0xCF}));
  EXPECT_DOUBLE_EQ(reading.value, 16.603);
}

// Each layout read from a frame by hand: bytes 12 34 56 78 9A BC DE F0.
TEST(DbcFile, ReadsEveryOrderSignAndLength) {
  const CanFrame f = frame(100, {0x12, 0x34, 0x56, 0x78, 0x9A, 0xBC, 0xDE, 0xF0});
  struct Case {
    const char* layout;
    double value;
  };
  for (const Case& c : {
           Case{"0|16@1+ (1,0)", 0x3412}, Case{"7|16@0+ (1,0)", 0x1234},
           Case{"4|8@1+ (1,0)", 0x41},          // high nibble of 12, low nibble of 34 above it
           Case{"3|8@0+ (1,0)", 0x23},          // low nibble of 12, high nibble of 34 below it
           Case{"56|8@1- (1,0)", -16},          // F0 = -16
           Case{"63|4@0- (1,0)", -1},           // high nibble F
           Case{"56|1@1+ (1,0)", 0},            // lowest bit of F0
           Case{"63|1@0+ (1,0)", 1},            // its highest
           Case{"0|8@1+ (0.5,-40)", -31},       // 18 / 2 - 40
           Case{"0|8@1+(-2,1E+1)", -26},        // 18 * -2 + 10
           Case{"0|8@1+ (+.25,+1.5e1)", 19.5},  // 18 / 4 + 15
           Case{"0|64@1- (1,0)", -1090226688147180526.0},  // F0DEBC9A78563412
           Case{"7|64@0+ (1,0)", 1311768467463790320.0},   // 123456789ABCDEF0
       }) {
    const LoadedDbc loaded = parse(message(" SG_ S : " + std::string(c.layout) + " [0|0] \"\" N"));
    ASSERT_THAT(loaded.faults, IsEmpty()) << c.layout;
    EXPECT_EQ(read_signal(find(loaded, "M.S").signal, f).value, c.value) << c.layout;
  }
}

TEST(DbcFile, AnIdWithBit31HasTwentyNineBits) {
  // 2147484937 = 0x80000509, 2566845669 = 0x98FEF4E5.
  const LoadedDbc loaded = parse(
      "BO_ 2147484937 A: 8 N\n SG_ S : 0|8@1+ (1,0) [0|0] \"\" N\n"
      "BO_ 2566845669 B: 8 N\n SG_ S : 0|8@1+ (1,0) [0|0] \"\" N\n"
      "BO_ 2048 C: 8 N\n SG_ S : 0|8@1+ (1,0) [0|0] \"\" N\n"
      "BO_ 3221225472 VECTOR__INDEPENDENT_SIG_MSG: 0 Vector__XXX\n"
      " SG_ Loose : 0|8@1+ (1,0) [0|0] \"\" Vector__XXX\n");
  EXPECT_THAT(loaded.faults, IsEmpty());
  EXPECT_EQ(find(loaded, "A.S").signal.id, 0x509u);
  EXPECT_TRUE(find(loaded, "A.S").signal.extended);
  EXPECT_EQ(find(loaded, "B.S").signal.id, 0x18FEF4E5u);
  EXPECT_THAT(fault_of(loaded, "C.S"), HasSubstr("more than 11 bits; a 29-bit id has 2147483648"));
  EXPECT_THAT(fault_of(loaded, "VECTOR__INDEPENDENT_SIG_MSG.Loose"), HasSubstr("no message"));
  EXPECT_THAT(loaded.file.messages(), SizeIs(3));
}

TEST(DbcFile, ValueTypesMakeFloatsAndDoubles) {
  const LoadedDbc loaded = parse(
      "BO_ 100 M: 8 N\n SG_ F : 0|32@1- (1,0) [0|0] \"\" N\n"
      " SG_ I : 32|32@1- (1,0) [0|0] \"\" N\n"
      "BO_ 101 D: 8 N\n SG_ D : 7|64@0- (1,0) [0|0] \"\" N\n SG_ Short : 0|16@1- (1,0) [0|0] \"\" "
      "N\n"
      "SIG_VALTYPE_ 100 F : 1;\nSIG_VALTYPE_ 100 I : 0;\nSIG_VALTYPE_ 101 D : 2;\n"
      "SIG_VALTYPE_ 101 Short : 1;\nSIG_VALTYPE_ 999 Nobody : 1;\n");
  EXPECT_THAT(loaded.faults, IsEmpty());
  // 1.5f = 3FC00000, -2 as int32; 2.5 = 4004000000000000.
  const CanFrame f = frame(100, {0, 0, 0xC0, 0x3F, 0xFE, 0xFF, 0xFF, 0xFF});
  EXPECT_EQ(read_signal(find(loaded, "M.F").signal, f).value, 1.5);
  EXPECT_EQ(read_signal(find(loaded, "M.I").signal, f).value, -2);
  EXPECT_EQ(read_signal(find(loaded, "D.D").signal, frame(101, {0x40, 4, 0, 0, 0, 0, 0, 0})).value,
            2.5);
  EXPECT_THAT(fault_of(loaded, "D.Short"), HasSubstr("a float of 16 bits; expected 32"));
}

TEST(DbcFile, MultiplexedSignalsAreThereWhenTheirMultiplexerSaysSo) {
  const LoadedDbc loaded = parse(
      message(" SG_ Page M : 0|4@1+ (1,0) [0|0] \"\" N\n SG_ One m1 : 8|8@1+ (1,0) [0|0] \"\" N\n"
              " SG_ Ten m10 : 8|8@1+ (1,0) [0|0] \"\" N"));
  EXPECT_THAT(loaded.faults, IsEmpty());
  using Status = SignalReading::Status;
  EXPECT_EQ(read_signal(find(loaded, "M.One").signal, frame(100, {1, 7})).raw, 7);
  EXPECT_EQ(read_signal(find(loaded, "M.Ten").signal, frame(100, {1, 7})).status, Status::kOther);
  EXPECT_EQ(read_signal(find(loaded, "M.Ten").signal, frame(100, {0xFA, 7})).raw, 7);
  EXPECT_EQ(read_signal(find(loaded, "M.Page").signal, frame(100, {0xFA, 7})).raw, 10);
}

TEST(DbcFile, MultiplexersMayBeMultiplexedThemselves) {
  const LoadedDbc loaded = parse(
      message(
          " SG_ Outer M : 0|8@1+ (1,0) [0|0] \"\" N\n SG_ Inner m2M : 8|8@1+ (1,0) [0|0] \"\" N\n"
          " SG_ Deep m0 : 16|8@1+ (1,0) [0|0] \"\" N\n"
          " SG_ Flat m5 : 16|8@1+ (1,0) [0|0] \"\" N") +
      "SG_MUL_VAL_ 100 Inner Outer 2-2;\nSG_MUL_VAL_ 100 Deep Inner 3-4, 7-7;\n"
      "SG_MUL_VAL_ 100 Flat Outer 5-6 ;\n");
  EXPECT_THAT(loaded.faults, IsEmpty());
  const CanSignal deep = find(loaded, "M.Deep").signal;
  const CanSignal flat = find(loaded, "M.Flat").signal;
  for (int outer = 0; outer < 9; ++outer) {
    for (int inner = 0; inner < 9; ++inner) {
      const CanFrame f = frame(100, {outer, inner, 42});
      const bool is_deep = outer == 2 && (inner == 3 || inner == 4 || inner == 7);
      EXPECT_EQ(read_signal(deep, f).raw, is_deep ? 42 : 0) << outer << inner;
      EXPECT_EQ(read_signal(flat, f).raw, outer == 5 || outer == 6 ? 42 : 0) << outer << inner;
    }
  }
}

TEST(DbcFile, MultiplexersThatCannotBeFollowedAreFaultsOfTheirSignals) {
  const std::string tail = " : 0|8@1+ (1,0) [0|0] \"\" N\n";
  const LoadedDbc two = parse(message(" SG_ A M" + tail + " SG_ B M" + tail + " SG_ S m1" + tail));
  EXPECT_THAT(fault_of(two, "M.S"), HasSubstr("several multiplexers; expected SG_MUL_VAL_"));
  EXPECT_THAT(fault_of(parse(message(" SG_ S m1" + tail)), "M.S"), HasSubstr("multiplexer (M)"));
  const LoadedDbc ring = parse(message(" SG_ A m1M" + tail + " SG_ B m1M" + tail) +
                               "SG_MUL_VAL_ 100 A B 1-1;\nSG_MUL_VAL_ 100 B A 1-1;\n");
  EXPECT_THAT(ring.faults, IsEmpty());
  EXPECT_THAT(fault_of(ring, "M.A"), HasSubstr("more than 3 multiplexers above each other"));
  const LoadedDbc many =
      parse(message(" SG_ A M" + tail + " SG_ S m1" + tail) +
            "SG_MUL_VAL_ 100 S A 0-0,2-2,4-4,6-6,8-8,10-10,12-12,14-14,16-16;\n");
  EXPECT_THAT(fault_of(many, "M.S"), HasSubstr("more than 8 ranges"));
}

TEST(DbcFile, CycleTimesComeFromTheMessageOrTheDefault) {
  const std::string file =
      "BO_ 1 A: 8 N\n SG_ S : 0|8@1+ (1,0) [0|0] \"\" N\nBO_ 2 B: 8 N\n"
      " SG_ S : 0|8@1+ (1,0) [0|0] \"\" N\nBO_ 3 C: 8 N\n SG_ S : 0|8@1+ (1,0) [0|0] \"\" N\n"
      "BA_DEF_ BO_ \"GenMsgCycleTime\" INT 0 65535;\nBA_ \"GenMsgCycleTime\" BO_ 1 10;\n"
      "BA_ \"GenMsgCycleTime\" BO_ 3 0;\nBA_ \"Other\" BO_ 2 5;\nBA_ \"Name\" \"a bus\";\n";
  const LoadedDbc none = parse(file);
  EXPECT_THAT(none.faults, IsEmpty());
  EXPECT_EQ(find(none, "A.S").cycle_s, 0.01);
  EXPECT_EQ(find(none, "B.S").cycle_s, std::nullopt);
  const LoadedDbc with = parse(file + "BA_DEF_DEF_ \"GenMsgCycleTime\" 100;\n");
  EXPECT_EQ(find(with, "A.S").cycle_s, 0.01);
  EXPECT_EQ(find(with, "B.S").cycle_s, 0.1);
  EXPECT_EQ(find(with, "C.S").cycle_s, std::nullopt);  // 0: not cyclic
}

TEST(DbcFile, SkipsEveryOtherStatement) {
  const LoadedDbc loaded = parse(
      "\xEF\xBB\xBFVERSION \"BO_ 1 X: 8 N\"\r\n\r\nNS_ : \r\n\tNS_DESC_\r\n\tCM_\r\n\tBA_DEF_\r\n"
      "\tSOMETHING_NEW_\r\n\tSG_MUL_VAL_\r\n\r\nBS_: 500 : 1,2\r\n\r\nBU_: N O Vector__XXX\r\n  "
      "P\r\n"
      "VAL_TABLE_ T 1 \"on; off\" 0 \"BO_ 7 No: 8 N\" ;\r\n"
      "BO_ 100 M: 8 N\r\n SG_ S : 0|8@1+ (1,0) [0|255] \"\xB0\\\"C; \" N,O P\r\n\r\n"
      "BO_TX_BU_ 100 : N,O;\r\nEV_ E: 0 [0|1] \"\" 0 2 DUMMY_NODE_VECTOR0 Vector__XXX;\r\n"
      "ENVVAR_DATA_ E: 5;\r\nEV_DATA_ E: 5;\r\n"
      "SGTYPE_ T : 8@1+ (1,0) [0|1] \"\" 0 , V;\r\nSIG_GROUP_ 100 G 1 : S;\r\n"
      "CM_ SG_ 100 S \"a text over\r\nBO_ 101 No: 8 N\r\nseveral lines; \\\"quoted\\\" too\";\r\n"
      "CM_ BU_ N \"x\";\r\nCM_ EV_ E \"x\";\r\nCM_ \"x\";\r\n"
      "BA_DEF_ \"A\" STRING ;\r\nBA_DEF_ BU_ \"B\" ENUM \"x\",\"y;\";\r\nBA_DEF_REL_ BU_SG_REL_ "
      "\"R\" "
      "INT 0 1;\r\n"
      "BA_DEF_DEF_ \"A\" \"\";\r\nBA_DEF_DEF_REL_ \"R\" 0;\r\nBA_ \"A\" \"v\";\r\nBA_ \"B\" BU_ N "
      "1;\r\n"
      "BA_REL_ \"R\" BU_SG_REL_ N SG_ 100 S 1;\r\nBU_SG_REL_ N SG_ 100 S;\r\n"
      "BA_DEF_SGTYPE_ \"x\" INT 0 1;\r\nBA_SGTYPE_ \"x\" T 1;\r\nSIG_TYPE_REF_ 100 S : T;\r\n"
      "SIGTYPE_VALTYPE_ T : 1;\r\nSGTYPE_VAL_ T 0 \"a\";\r\nCAT_DEF_ 1 x 2;\r\nCAT_ 1 x 2;\r\n"
      "FILTER 1 x 2;\r\nVAL_ 100 S 1 \"one\"\r\n 2 \"two\" ;\r\n"
      "BO_ 200 Last: 8 N\r\n SG_ S : 0|8@1+ (1,0) [0|0] \"\" Vector__XXX");
  EXPECT_THAT(loaded.faults, IsEmpty());
  ASSERT_THAT(loaded.file.messages(), SizeIs(2));
  EXPECT_EQ(find(loaded, "M.S").unit, "\xB0\\\"C; ");
  EXPECT_EQ(find(loaded, "Last.S").signal.id, 200u);
  EXPECT_EQ(loaded.file.messages()[0].signals[0].most, 255);
}

TEST(DbcFile, SymbolsMayStandOnOneLineOrBeFollowedByNothing) {
  EXPECT_THAT(parse("NS_ : CM_ BA_DEF_ BA_\nBS_:\nBU_:\nCM_ \"x\";").faults, IsEmpty());
  EXPECT_THAT(parse("NS_ :\n CM_\n BA_\nCM_ BO_ 1 \"x\";\nBA_ \"a\" 1;").faults, IsEmpty());
  EXPECT_THAT(parse("NS_ :\n CM_").faults, IsEmpty());
  EXPECT_THAT(parse("").faults, IsEmpty());
}

TEST(DbcFile, LongNamesAreNamesAndSoAreTheShortOnes) {
  const LoadedDbc loaded =
      parse(message(" SG_ Short_0 : 0|8@1+ (1,0) [0|0] \"\" N") +
            "BA_ \"SystemSignalLongSymbol\" SG_ 100 Short_0 \"AVeryLongName\";\n"
            "BA_ \"SystemMessageLongSymbol\" BO_ 100 \"LongMessage\";\n"
            "SIG_VALTYPE_ 100 Short_0 : 0;\n");
  EXPECT_THAT(loaded.slips, IsEmpty());
  for (const char* name : {"M.Short_0", "M.AVeryLongName", "LongMessage.AVeryLongName"}) {
    EXPECT_EQ(find(loaded, name).signal.id, 100u) << name;
  }
}

TEST(DbcFile, MessagesOfOneNameAreToldApartByTheirIds) {
  const std::string signal = " SG_ S : 0|8@1+ (1,0) [0|0] \"\" N\n";
  const LoadedDbc loaded = parse("BO_ 100 M: 8 N\n" + signal + "BO_ 101 M: 8 N\n" + signal +
                                 " SG_ T : 8|8@1+ (1,0) [0|0] \"\" N\n");
  EXPECT_EQ(find(loaded, "M.T").signal.id, 101u);
  EXPECT_EQ(find(loaded, "M@100.S").signal.id, 100u);
  EXPECT_EQ(find(loaded, "M@0x65.S").signal.id, 101u);
  EXPECT_THAT(fault_of(loaded, "M.S"),
              HasSubstr("lines 1 and 3 both define a message M; say which one by its id: M@100.S"));
  EXPECT_THAT(fault_of(loaded, "M@102.S"), HasSubstr("no message M@102"));
}

}  // namespace
}  // namespace zonepack
