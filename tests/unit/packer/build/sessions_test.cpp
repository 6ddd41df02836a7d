// SPDX-License-Identifier: Apache-2.0
#include "packer/build/sessions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace zonepack::packer {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

std::string layer_refusal(const std::string& text) {
  try {
    parse_layer(text);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

template <typename Do>
std::string text_thrown_by(Do what) {
  try {
    what();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(Layers, AreReadAsNumbersAndRanges) {
  const NamedLayer layer = parse_layer("rooms=7,1-3,5");
  EXPECT_EQ(layer.name, "rooms");
  EXPECT_THAT(layer.sessions, ElementsAre(Pair(1, 3), Pair(5, 5), Pair(7, 7)));
  EXPECT_EQ(sessions_text(layer), "1-3,5,7");
}

TEST(Layers, JoinRangesThatTouchOrOverlap) {
  // 1 to 4 and 3 to 6 overlap, 7 follows 6, 9 stands alone.
  EXPECT_EQ(sessions_text(parse_layer("a=3-6,1-4,7,9")), "1-7,9");
  EXPECT_EQ(sessions_text(parse_layer("a=2147483647,2147483646")), "2147483646-2147483647");
}

TEST(Layers, AreRefusedWithWhatWasExpected) {
  EXPECT_THAT(layer_refusal("rooms"), HasSubstr("has no '='"));
  EXPECT_THAT(layer_refusal("rooms="), HasSubstr("has '' where a session's number belongs"));
  EXPECT_THAT(layer_refusal("rooms=1,,2"), HasSubstr("has '' where"));
  EXPECT_THAT(layer_refusal("rooms=-1"), HasSubstr("where a session's number belongs"));
  EXPECT_THAT(layer_refusal("rooms=2147483648"), HasSubstr("has '2147483648' where"));
  EXPECT_THAT(layer_refusal("rooms=3-1"), HasSubstr("ends before it begins"));
  EXPECT_THAT(layer_refusal("a,b=1"), HasSubstr("has a comma in its name"));
  EXPECT_THAT(layer_refusal("=1"), HasSubstr("unfit name"));
  EXPECT_THAT(layer_refusal("x=1x"), HasSubstr("such as skeleton=0 or rooms=1-3,5"));
}

TEST(Layers, OfOneNameReplaceTheMapsAndOthersAreAddedByName) {
  const std::vector<NamedLayer> held = {parse_layer("rooms=1"), parse_layer("skeleton=0")};
  const auto merged = merged_layers(held, {parse_layer("rooms=2-3"), parse_layer("cellar=9")});
  ASSERT_EQ(merged.size(), 3u);
  EXPECT_EQ(merged[0].name + "=" + sessions_text(merged[0]), "cellar=9");
  EXPECT_EQ(merged[1].name + "=" + sessions_text(merged[1]), "rooms=2-3");
  EXPECT_EQ(merged[2].name + "=" + sessions_text(merged[2]), "skeleton=0");
}

TEST(Layers, ShareNoSession) {
  EXPECT_THAT(text_thrown_by(
                  [] { merged_layers({parse_layer("skeleton=0-4")}, {parse_layer("rooms=4-6")}); }),
              HasSubstr("session 4 is in layer 'rooms' and in layer 'skeleton'"));
  EXPECT_THAT(text_thrown_by([] {
                merged_layers({}, {parse_layer("a=1"), parse_layer("a=2")});
              }),
              HasSubstr("layer 'a' is given twice"));
}

TEST(Layers, OfAZoneAreThoseOfMostOfItsSignatures) {
  const std::vector<NamedLayer> layers = {parse_layer("rooms=1-2"), parse_layer("skeleton=0")};
  // Rooms have 2 + 2 of them, the skeleton 3; session 7 is in no layer.
  EXPECT_EQ(most_common_layer(layers, {{0, 3}, {1, 2}, {2, 2}, {7, 9}}), "rooms");
  EXPECT_EQ(most_common_layer(layers, {{0, 5}, {1, 2}}), "skeleton");
  EXPECT_EQ(most_common_layer(layers, {{0, 2}, {1, 2}}), "rooms") << "of equals the first by name";
  EXPECT_EQ(most_common_layer(layers, {{7, 9}}), "");
  EXPECT_EQ(layer_of(layers, 7), nullptr);
  ASSERT_NE(layer_of(layers, 2), nullptr);
  EXPECT_EQ(layer_of(layers, 2)->name, "rooms");
}

TEST(SessionChoice, TakesSessionsOfItsLayersWithoutThoseDropped) {
  const std::vector<NamedLayer> layers = {parse_layer("rooms=1-3"), parse_layer("skeleton=0")};
  SessionChoice choice;
  EXPECT_TRUE(choice.all());
  EXPECT_TRUE(choice.takes(layers, 9));
  choice.layers = {"rooms"};
  choice.dropped = {2};
  EXPECT_FALSE(choice.all());
  EXPECT_TRUE(choice.takes(layers, 3));
  EXPECT_FALSE(choice.takes(layers, 2));
  EXPECT_FALSE(choice.takes(layers, 0));
  EXPECT_FALSE(choice.takes(layers, 9)) << "of no layer";
}

TEST(SessionChoice, IsRefusedWhereItNamesWhatIsNotThere) {
  const std::vector<NamedLayer> layers = {parse_layer("rooms=1")};
  SessionChoice choice;
  choice.dropped = {4};
  EXPECT_THAT(text_thrown_by([&] {
                require_known(choice, layers, {{0, 5}, {1, 2}}, "map.db");
              }),
              HasSubstr("map.db: has no session 4, which --drop-session names; it has 0, 1"));
  choice = {};
  choice.layers = {"roms"};
  EXPECT_THAT(text_thrown_by([&] {
                require_known(choice, layers, {{1, 2}}, "map.db");
              }),
              HasSubstr("'roms', which no --layer names"));
  choice.layers = {"rooms"};
  EXPECT_EQ(text_thrown_by([&] { require_known(choice, layers, {{1, 2}}, "map.db"); }), "");
}

}  // namespace
}  // namespace zonepack::packer
