// SPDX-License-Identifier: Apache-2.0
#include "runtime/zones/transitions_file.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "tests/support/rooms.hpp"

namespace zonepack {
namespace {

using testing_support::box;
using testing_support::three_rooms;

constexpr std::int64_t kDrivenSecond_ns = 1'000'000'000;

class TransitionsFile : public testing::Test {
 protected:
  TransitionsFile() {
    for (int i = 0; i < 3; ++i) {
      table.learn(kNoZone, 0, 1, 4 * kDrivenSecond_ns);
      table.learn(0, 1, 2, 5 * kDrivenSecond_ns);
      table.learn(1, 2, 1, 30 * kDrivenSecond_ns);
    }
  }

  LearnedTransitions learned() const {
    LearnedTransitions saved = save(table);
    saved.map_lineage[3] = 7;
    saved.map_version[5] = 9;
    return saved;
  }

  const ZoneGraph graph = three_rooms();
  Transitions table{graph};
};

TEST_F(TransitionsFile, IsReadAsItWasWritten) {
  const auto bytes = write_transitions(learned());
  const auto read = read_transitions(bytes);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->map_lineage[3], 7);
  EXPECT_EQ(read->map_version[5], 9);
  EXPECT_EQ(read->zones, (std::vector<std::string>{"a", "b", "c"}));
  EXPECT_EQ(*read, learned());
  EXPECT_EQ(write_transitions(*read), bytes);
  Transitions other(graph);
  restore(*read, other);
  EXPECT_EQ(other.steps(), 9u);
  EXPECT_EQ(write_transitions(save(other)), write_transitions(save(table)));
}

TEST_F(TransitionsFile, FitsAMapWhoseZonesKeptTheirNames) {
  // A zone a0 came between, so that ids differ; c is gone.
  const GraphPortal portals[] = {{0, 2, {{4, 1.5}, {4, 2.5}}}};
  const ZoneGraph next({{"a", box(0, 0, 4, 4)}, {"a0", box(0, 4, 4, 8)}, {"b", box(4, 0, 8, 4)}},
                       portals);
  Transitions there(next);
  restore(learned(), there);
  ASSERT_EQ(there.contexts().size(), 1u);  // from a to b; all others need c
  EXPECT_EQ(there.contexts()[0].before, kNoZone);
  EXPECT_EQ(there.contexts()[0].now, 0u);
  EXPECT_EQ(there.contexts()[0].next[0].zone, 2u);
  Transitions taken(next);
  taken.take_over(table);
  EXPECT_EQ(write_transitions(save(taken)), write_transitions(save(there)));
}

TEST_F(TransitionsFile, IsRefusedWhenItIsCutAnywhere) {
  const auto bytes = write_transitions(learned());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const auto read = read_transitions(ByteSpan(bytes).first(size));
    EXPECT_FALSE(read) << size;
    EXPECT_FALSE(read.error().message.empty()) << size;
  }
}

TEST_F(TransitionsFile, IsRefusedWhenAByteIsAnother) {
  const auto bytes = write_transitions(learned());
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    if (at == 10 || at == 11) continue;  // the minor version, any of which is read
    auto damaged = bytes;
    damaged[at] ^= std::byte{1};
    EXPECT_FALSE(read_transitions(damaged)) << at;
  }
}

TEST_F(TransitionsFile, IsRefusedWhenItsNumbersAreForged) {
  const auto forged = [&](auto change) {
    LearnedTransitions bad = learned();
    change(bad);
    const auto read = read_transitions(write_transitions(bad));
    return read ? std::string("read") : read.error().message;
  };
  using L = LearnedTransitions;
  EXPECT_NE(forged([](L& l) { l.contexts[0].now = 3; }).find("context 0"), std::string::npos);
  EXPECT_NE(forged([](L& l) { l.contexts[1].next[0].zone = 77; }).find("context 1"),
            std::string::npos);
  EXPECT_NE(forged([](L& l) { l.contexts[1].next[0].count = 0; }).find("context 1"),
            std::string::npos);
  EXPECT_NE(forged([](L& l) { l.contexts[0].next[0].count = 65537; }).find("context 0"),
            std::string::npos);
  EXPECT_NE(forged([](L& l) { std::swap(l.contexts[0], l.contexts[1]); }).find("context 1"),
            std::string::npos);
  EXPECT_NE(forged([](L& l) { std::swap(l.zones[0], l.zones[1]); }).find("zone 1"),
            std::string::npos);
  EXPECT_NE(forged([](L& l) { l.zones[0] = "../a"; }).find("zone 0"), std::string::npos);
  EXPECT_NE(forged([](L& l) { l.contexts.resize(2049); }).find("2049 contexts"), std::string::npos);
}

}  // namespace
}  // namespace zonepack
