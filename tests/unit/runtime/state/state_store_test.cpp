// SPDX-License-Identifier: Apache-2.0
#include "runtime/state/state_store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "runtime/state/state_saver.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

SavedState somewhere(double x_m = 1.5) {
  SavedState state;
  state.runs = 3;
  state.map_lineage.fill(7);
  state.map_version.fill(8);
  state.realtime_ns = 1234;
  state.T_map_base = {x_m, -2.5, 3};
  state.covariance = {0.01, 0.001, 0.002, 0.04, 0.003, 0.0009};
  state.trusted = true;
  state.zone = "L1";
  return state;
}

TEST(SavedState, ReadsBackAsItWas) {
  const auto back = read_state(write_state(somewhere()));
  ASSERT_TRUE(back.ok());
  EXPECT_EQ(back->T_map_base, somewhere().T_map_base);
  EXPECT_EQ(back->covariance, somewhere().covariance);
  EXPECT_EQ(back->map_lineage, somewhere().map_lineage);
  EXPECT_EQ(back->map_version, somewhere().map_version);
  EXPECT_EQ(back->zone, "L1");
  EXPECT_EQ(back->runs, 3u);
  EXPECT_EQ(back->realtime_ns, 1234);
  EXPECT_TRUE(back->trusted);
}

TEST(SavedState, IsRefusedWithAnyBitFlippedAndAtAnyShorterLength) {
  const std::vector<std::byte> whole = write_state(somewhere());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(read_state(std::span(whole).first(size)).ok()) << size;
  }
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    if (bit / 8 == 10 || bit / 8 == 11) continue;  // the minor version, which may be any
    std::vector<std::byte> changed = whole;
    changed[bit / 8] ^= static_cast<std::byte>(1 << (bit % 8));
    EXPECT_FALSE(read_state(changed).ok()) << bit;
  }
}

TEST(SavedState, IsRefusedWhenItsPoseIsNotANumber) {
  SavedState state = somewhere();
  state.T_map_base.x_m = std::numeric_limits<double>::infinity();
  EXPECT_EQ(read_state(write_state(state)).error().code, ErrorCode::kBadValue);
}

class StateStoreTest : public testing::Test {
 protected:
  StateStore::Found load() { return StateStore(folder.path()).load(somewhere().map_lineage); }
  test_support::TemporaryFolder folder;
};

TEST_F(StateStoreTest, FindsTheNewestOfTwoAndFallsBackToTheOneBefore) {
  StateStore store(folder.path());
  EXPECT_FALSE(store.load(somewhere().map_lineage).state);
  for (double x_m = 1; x_m <= 5; ++x_m) ASSERT_TRUE(store.save(somewhere(x_m)).ok());
  EXPECT_EQ(load().state->T_map_base.x_m, 5);
  EXPECT_TRUE(load().notes.empty());
  // 1, 3 and 5 went to state-0. Torn, it leaves 4.
  fs::resize_file(folder / "state-0", 100);
  const auto found = load();
  EXPECT_EQ(found.state->T_map_base.x_m, 4);
  EXPECT_THAT(found.notes,
              ElementsAre(HasSubstr("state-0: saved state cannot be used: truncated")));
  // The next one does not replace the one that is whole.
  StateStore again(folder.path());
  again.load(somewhere().map_lineage);
  ASSERT_TRUE(again.save(somewhere(6)).ok());
  EXPECT_EQ(load().state->T_map_base.x_m, 6);
  fs::remove(folder / "state-0");
  EXPECT_EQ(load().state->T_map_base.x_m, 4);
}

TEST_F(StateStoreTest, NeitherFollowsALinkNorWaitsForAPipe) {
  std::ofstream(folder / "target") << "precious";
  fs::create_symlink(folder / "target", folder / "state-0");
  StateStore store(folder.path());
  EXPECT_THAT(store.load(somewhere().map_lineage).notes,
              ElementsAre(HasSubstr("state-0: is a symbolic link; expected a file")));
  for (double x_m = 1; x_m <= 3; ++x_m) EXPECT_TRUE(store.save(somewhere(x_m)).ok());
  EXPECT_EQ(load().state->T_map_base.x_m, 3) << "by state-1 alone";
  fs::remove(folder / "state-1");
  ASSERT_EQ(mkfifo((folder / "state-1").c_str(), 0600), 0);
  EXPECT_THAT(store.load(somewhere().map_lineage).notes,
              ElementsAre(HasSubstr("state-0: is a symbolic link"),
                          HasSubstr("state-1: is a FIFO; expected a file")));
  EXPECT_EQ(store.save(somewhere()).error(), (Error{ErrorCode::kIo, EEXIST}));
  std::ostringstream target;
  target << std::ifstream(folder / "target").rdbuf();
  EXPECT_EQ(target.str(), "precious");
}

TEST_F(StateStoreTest, RefusesAStateOfAnotherMapAndReplacesIt) {
  SavedState other = somewhere();
  other.map_lineage.fill(9);
  StateStore store(folder.path());
  store.load(other.map_lineage);
  ASSERT_TRUE(store.save(other).ok());
  const auto found = load();
  EXPECT_FALSE(found.state);
  EXPECT_THAT(found.notes, ElementsAre(HasSubstr("belongs to another map")));
  StateStore mine(folder.path());
  mine.load(somewhere().map_lineage);
  ASSERT_TRUE(mine.save(somewhere()).ok());
  EXPECT_TRUE(load().state);
}

class StateSaverTest : public testing::Test {
 protected:
  StateSaverTest() {
    store.load(somewhere().map_lineage);
    glimpse.pose.valid = true;
    glimpse.zone = 1;
  }
  void pass(double seconds) {
    glimpse.now_ns += static_cast<std::int64_t>(seconds * 1e9);
    saver.watch();
  }
  std::optional<SavedState> saved() {
    return StateStore(store.folder()).load(somewhere().map_lineage).state;
  }

  test_support::TemporaryFolder folder;
  StateStore store{(folder / "state").string()};
  StateGlimpse glimpse;
  std::uint32_t gone = 0;  // a map
  std::vector<std::string> told;
  StateSaver saver{store, somewhere(), [this] { return glimpse; },
                   [this](const StateGlimpse& now, SavedState& state) {
                     if (now.map == gone) return false;
                     state.map_version[0] = static_cast<std::uint8_t>(now.map);
                     state.zone = "Z" + std::to_string(now.zone);
                     return true;
                   },
                   [this](std::string text) { told.push_back(std::move(text)); }};
};

TEST_F(StateSaverTest, SavesTheMapOfTheZoneAndWaitsWhenThatIsGone) {
  glimpse.pose.valid = true;
  pass(1);
  EXPECT_EQ(saved()->map_version[0], 1);
  gone = glimpse.map = 2;
  pass(1);
  EXPECT_EQ(saver.saved(), 1u);
  gone = 1;
  pass(1);
  EXPECT_EQ(saved()->map_version[0], 2);
  EXPECT_EQ(saver.saved(), 2u);
}

TEST_F(StateSaverTest, SavesOnAChangeOfZoneAtTheEndAndElseOnceAMinute) {
  glimpse.pose.valid = false;
  pass(100);
  EXPECT_EQ(saver.saved(), 0u);  // nothing is known yet
  glimpse.pose.valid = true;
  pass(1);
  EXPECT_EQ(saver.saved(), 1u);
  for (int i = 0; i < 59; ++i) pass(1);
  EXPECT_EQ(saver.saved(), 1u);
  pass(1);
  EXPECT_EQ(saver.saved(), 2u);
  glimpse.zone = 2;
  pass(0.01);
  EXPECT_EQ(saver.saved(), 3u);
  EXPECT_EQ(saved()->zone, "Z2");
  glimpse.pose.T_map_base.x_m = 77;
  saver.stop();
  EXPECT_EQ(saver.saved(), 4u);
  EXPECT_EQ(saved()->T_map_base.x_m, 77);
  EXPECT_EQ(saved()->runs, 3u);
}

TEST_F(StateSaverTest, CountsWhatCannotBeSavedReportsItOnceAndContinues) {
  fs::remove_all(folder / "state");
  for (int i = 0; i < 5; ++i) pass(60);
  EXPECT_EQ(saver.saved(), 0u);
  EXPECT_EQ(saver.failures(), 5u);
  EXPECT_THAT(told, ElementsAre(HasSubstr("No such file or directory")));
  fs::create_directories(folder / "state");
  pass(60);
  EXPECT_EQ(saver.saved(), 1u);
  EXPECT_EQ(told.size(), 2u);
}

TEST(GuessFrom, IsNeverSurerThanAStartThatWasGiven) {
  PoseFilterSettings settings;  // 0.5 m, 0.2 rad
  const RestoredStart sure = guess_from(somewhere(), settings);
  EXPECT_EQ(sure.sigma_m, 0.5);
  EXPECT_EQ(sure.sigma_rad, 0.2);
  SavedState lost = somewhere();
  lost.covariance = {9, 0, 0, 4, 0, 1};
  EXPECT_DOUBLE_EQ(guess_from(lost, settings).sigma_m, 6);  // 2 * 3 m
  EXPECT_DOUBLE_EQ(guess_from(lost, settings).sigma_rad, 2);
}

}  // namespace
}  // namespace zonepack
