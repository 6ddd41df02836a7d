// SPDX-License-Identifier: Apache-2.0
#include "runtime/recording/map_block.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "runtime/recording/block.hpp"

namespace zonepack {
namespace {

// The contents of blocks that follow one another.
std::vector<std::vector<std::byte>> contents(ByteSpan blocks) {
  std::vector<std::vector<std::byte>> all;
  while (!blocks.empty()) {
    const auto header = read_block_header(blocks.first(kBlockHeaderBytes));
    EXPECT_TRUE(header && header->kind == static_cast<std::uint8_t>(BlockKind::kMap));
    const std::size_t size = kBlockHeaderBytes + header->stored_size;
    EXPECT_TRUE(open_block(blocks.first(size), all.emplace_back()));
    blocks = blocks.subspan(size);
  }
  return all;
}

TEST(MapBlock, GivesBackMapsOfSeveralBlocksOneAfterTheOther) {
  RecordedMap large{.number = 2,
                    .folder = "/maps/ward",
                    .manifest = std::vector<std::byte>(1'500'000, std::byte{7})};
  large.manifest.back() = std::byte{8};
  const RecordedMap small{.number = 3, .folder = "", .manifest = {std::byte{9}}};
  RecordedMaps maps;
  const auto blocks = contents(write_map(large));
  EXPECT_EQ(blocks.size(), 3u);
  for (const auto& content : blocks) {
    EXPECT_EQ(maps.find(2), nullptr);
    EXPECT_TRUE(maps.add(content));
  }
  for (const auto& content : contents(write_map(small))) EXPECT_TRUE(maps.add(content));
  ASSERT_NE(maps.find(2), nullptr);
  EXPECT_EQ(maps.find(2)->folder, large.folder);
  EXPECT_EQ(maps.find(2)->manifest, large.manifest);
  ASSERT_NE(maps.find(3), nullptr);
  EXPECT_EQ(maps.find(3)->manifest, small.manifest);
  EXPECT_EQ(maps.find(4), nullptr);
}

TEST(MapBlock, RefusesWhatIsNoMapAndKeepsThoseBefore) {
  RecordedMaps maps;
  const auto good = contents(write_map({2, "m", {std::byte{1}, std::byte{2}}}))[0];
  ASSERT_TRUE(maps.add(good));
  auto longer = good;
  longer.push_back(std::byte{});
  EXPECT_FALSE(maps.add(longer));
  auto first = good;
  first[0] = std::byte{1};  // the preface's number
  EXPECT_FALSE(maps.add(first));
  EXPECT_FALSE(maps.add(ByteSpan(good).first(3)));
  ASSERT_TRUE(maps.add(good));
  EXPECT_EQ(maps.find(2)->manifest.size(), 2u);
}

}  // namespace
}  // namespace zonepack
