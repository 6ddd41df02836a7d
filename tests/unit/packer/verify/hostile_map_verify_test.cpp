// SPDX-License-Identifier: Apache-2.0
// What verify and plan say of maps that lie to a robot with right digests.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "packer/decode/map_reader.hpp"
#include "packer/verify/map_verifier.hpp"
#include "tests/support/hostile_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

using testing::HasSubstr;

constexpr Digest16 kLineage = {1, 2, 3};

std::vector<std::string> lines_of(const Verdict& verdict) {
  std::vector<std::string> lines;
  for (const Problem& problem : verdict.problems) lines.push_back(to_string(problem));
  return lines;
}

Verdict verdict_on(const std::string& kind) {
  return verify_map(test_support::hostile_map(kind, kLineage));
}

class HostileMapVerify : public testing::TestWithParam<test_support::HostileKind> {};

// Three lists are bounded: of a pack, of what the manifest says of its zone, and of the map.
TEST_P(HostileMapVerify, FindsFaultsAndPrintsFewLinesWithoutControlCharacters) {
  const Verdict verdict = verdict_on(GetParam().name);
  EXPECT_FALSE(verdict.whole());
  EXPECT_LE(verdict.problems.size(), 3 * (kMostListed + 1));
  for (const std::string& line : lines_of(verdict)) {
    EXPECT_TRUE(std::ranges::none_of(line, [](char c) {
      return static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
    })) << line;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, HostileMapVerify, testing::ValuesIn(test_support::hostile_kinds()),
                         [](const auto& test) {
                           std::string name = test.param.name;
                           std::erase(name, '-');
                           return name;
                         });

TEST(HostileMapVerify, NamesBytesBehindTheFlatBufferAsPlanDoes) {
  EXPECT_THAT(lines_of(verdict_on("trailing")),
              testing::ElementsAre(HasSubstr("manifest.zpm: the file has more bytes than")));
  const test_support::TemporaryFolder folder;
  for (const auto& [name, bytes] : test_support::hostile_map("trailing", kLineage).files) {
    test_support::write_bytes(folder / name, bytes);
  }
  try {
    MapReader reader(folder.path());
    FAIL() << "read";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("more bytes than its zones, portals and texts take"));
  }
}

TEST(HostileMapVerify, NamesBytesBehindAnIndexOfAPack) {
  EXPECT_THAT(lines_of(verdict_on("index-trailing")),
              testing::Contains(HasSubstr("bytes, more than its chunks need")));
}

TEST(HostileMapVerify, NamesTheTextThatHoldsAControlCharacter) {
  EXPECT_THAT(lines_of(verdict_on("escape-frame")),
              testing::ElementsAre(HasSubstr("frame is not UTF-8 without control characters")));
  EXPECT_THAT(lines_of(verdict_on("escape-detector")),
              testing::ElementsAre(HasSubstr("provenance.detector is not UTF-8 without control")));
  EXPECT_THAT(lines_of(verdict_on("escape")),
              testing::ElementsAre(HasSubstr("zone entry 0: name is not UTF-8 without control")));
}

// A million images of a byte each, none with the BLAKE2b of its byte: 20 lines, one line for the
// other 999,980, and what the manifest says otherwise of the zone.
TEST(HostileMapVerify, ListsTwentyBadChunksOfAPackAndCountsTheRest) {
  const Verdict verdict = verdict_on("index-entries");
  const std::vector<std::string> lines = lines_of(verdict);
  ASSERT_GT(lines.size(), 20u);
  EXPECT_THAT(lines[0], HasSubstr("z.zpk: zone z000000, chunk 0 (image)"));
  EXPECT_THAT(lines[19], HasSubstr("chunk 19 (image)"));
  EXPECT_EQ(lines[20],
            "z.zpk: zone z000000: and 999980 more problems; see to those that are listed, then "
            "verify again");
  EXPECT_EQ(verdict.problem_count(), 1'000'000 + lines.size() - 21);
}

}  // namespace
}  // namespace zonepack::packer
