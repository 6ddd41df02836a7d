// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "platform/devices/gpio_line.hpp"

// What every GpioPort must do, whatever is behind it. A program includes this file once and names
// its rigs with INSTANTIATE_TEST_SUITE_P(NAME, GpioLineContract, testing::Values(make_rig, ...)).
namespace zonepack {

// A port under test with a chip of 8 lines, all low, of which line 3 is named "door", with control
// of their other ends.
class GpioRig {
 public:
  virtual ~GpioRig() = default;
  virtual GpioPort& port() = 0;
  virtual std::string label() = 0;
  virtual std::string chip_name() = 0;  // gpiochipN
  virtual void add_twin() = 0;          // another chip with the same label
  virtual void drive(unsigned line, bool high) = 0;
  virtual bool is_high(unsigned line) = 0;
  virtual void occupy(unsigned line) = 0;  // by another program, gpioset
  virtual std::int64_t now_ns() = 0;       // on the clock of the stamps
  virtual void pass(std::int64_t ns) = 0;  // at least
};

using GpioRigMaker = std::function<std::unique_ptr<GpioRig>()>;

class GpioLineContract : public testing::TestWithParam<GpioRigMaker> {
 protected:
  static constexpr std::int64_t kMs = 1'000'000;

  void SetUp() override {
    rig_ = GetParam()();
    if (!rig_) GTEST_SKIP() << "no such chip here";
  }

  GpioLineName name(const std::string& line) { return {.chip = rig_->label(), .line = line}; }

  std::unique_ptr<GpioInput> input(const std::string& line, std::int64_t debounce_ns = 0,
                                   bool active_low = false) {
    auto opened = rig_->port().open(GpioInputSettings{.name = name(line),
                                                      .active_low = active_low,
                                                      .bias = GpioBias::kAsIs,
                                                      .debounce_ns = debounce_ns});
    EXPECT_TRUE(opened.ok()) << explain_gpio(rig_->port(), name(line), opened.error());
    return opened ? std::move(opened).value() : nullptr;
  }

  std::unique_ptr<GpioOutput> output(const std::string& line, bool active,
                                     bool active_low = false) {
    auto opened = rig_->port().open(
        GpioOutputSettings{.name = name(line), .active_low = active_low, .active = active});
    EXPECT_TRUE(opened.ok()) << explain_gpio(rig_->port(), name(line), opened.error());
    return opened ? std::move(opened).value() : nullptr;
  }

  // The settled edges, taken a moment later, since kernels read lines on threads of their own.
  std::vector<GpioEdge> edges(GpioInput& from, std::size_t most = 64) {
    rig_->pass(20 * kMs);
    std::vector<GpioEdge> into(most);
    const auto count = from.take(into);
    EXPECT_TRUE(count.ok());
    into.resize(count.ok() ? *count : 0);
    return into;
  }

  std::string fault_of(const GpioLineName& line) {
    const auto opened = rig_->port().open(GpioInputSettings{.name = line});
    return opened ? "none" : explain_gpio(rig_->port(), line, opened.error());
  }

  std::unique_ptr<GpioRig> rig_;
};

TEST_P(GpioLineContract, AnOutputIsAsAskedForFromTheStartAndThenAsSet) {
  const auto plain = output("1", true);
  const auto low = output("2", true, true);
  ASSERT_TRUE(plain && low);
  EXPECT_TRUE(rig_->is_high(1));
  EXPECT_FALSE(rig_->is_high(2));
  for (const bool active : {false, true, true, false}) {
    ASSERT_TRUE(plain->set(active).ok());
    ASSERT_TRUE(low->set(active).ok());
    EXPECT_EQ(rig_->is_high(1), active);
    EXPECT_EQ(rig_->is_high(2), !active);
  }
}

TEST_P(GpioLineContract, AnInputReportsEachChangeInOrderStampedWhenItHappened) {
  const auto line = input("4");
  ASSERT_TRUE(line);
  EXPECT_EQ(edges(*line).size(), 0u);
  std::vector<std::int64_t> before, after;
  for (const bool high : {true, false, true}) {
    before.push_back(rig_->now_ns());
    rig_->drive(4, high);
    rig_->pass(5 * kMs);
    after.push_back(rig_->now_ns());
  }
  const auto got = edges(*line);
  ASSERT_EQ(got.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(got[i].active, i != 1);
    EXPECT_GE(got[i].stamp_ns, before[i]);
    EXPECT_LE(got[i].stamp_ns, after[i]);
  }
  EXPECT_EQ(edges(*line).size(), 0u);
}

TEST_P(GpioLineContract, AnInputThatIsActiveFromTheStartSaysSoOnce) {
  rig_->drive(4, true);
  const auto high = input("4");
  const auto low = input("5", 0, true);
  ASSERT_TRUE(high && low);
  for (GpioInput* const line : {high.get(), low.get()}) {
    const auto got = edges(*line);
    ASSERT_EQ(got.size(), 1u);
    EXPECT_TRUE(got[0].active);
    EXPECT_EQ(edges(*line).size(), 0u);
  }
  rig_->drive(5, true);
  const auto got = edges(*low);
  ASSERT_EQ(got.size(), 1u);
  EXPECT_FALSE(got[0].active);
}

TEST_P(GpioLineContract, GivesNoMoreThanAskedForAndKeepsTheRest) {
  const auto line = input("4");
  ASSERT_TRUE(line && edges(*line).empty());
  for (const bool high : {true, false, true}) {
    rig_->drive(4, high);
    rig_->pass(kMs);
  }
  EXPECT_EQ(edges(*line, 2).size(), 2u);
  const auto rest = edges(*line, 2);
  ASSERT_EQ(rest.size(), 1u);
  EXPECT_TRUE(rest[0].active);
}

TEST_P(GpioLineContract, ABounceShorterThanTheDebounceTimeIsNoEdge) {
  const auto line = input("4", 400 * kMs);
  ASSERT_TRUE(line && edges(*line).empty());
  rig_->drive(4, true);
  rig_->drive(4, false);
  rig_->pass(600 * kMs);
  EXPECT_EQ(edges(*line).size(), 0u);
  rig_->drive(4, true);
  rig_->drive(4, false);
  const std::int64_t last_ns = rig_->now_ns();
  rig_->drive(4, true);
  EXPECT_EQ(edges(*line).size(), 0u);  // not settled yet
  rig_->pass(600 * kMs);
  const auto got = edges(*line);
  ASSERT_EQ(got.size(), 1u);
  EXPECT_TRUE(got[0].active);
  EXPECT_GE(got[0].stamp_ns, last_ns);
  EXPECT_LE(got[0].stamp_ns, rig_->now_ns() - 600 * kMs);
}

TEST_P(GpioLineContract, EndsAtTheLineThatIsThereEvenWhenChangesWereLost) {
  const auto line = input("4");
  ASSERT_TRUE(line && edges(*line).empty());
  for (int i = 0; i < 41; ++i) {
    rig_->drive(4, i % 2 == 0);
    rig_->pass(kMs);
  }
  std::vector<GpioEdge> all;
  for (auto got = edges(*line); !got.empty(); got = edges(*line)) {
    all.insert(all.end(), got.begin(), got.end());
  }
  ASSERT_FALSE(all.empty());
  EXPECT_LE(all.size(), 41u);
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i].active, i % 2 == 0);
  EXPECT_TRUE(all.back().active);
}

TEST_P(GpioLineContract, FindsALineByLabelNameOrFileOfItsChipAndByNumberOrName) {
  for (const std::string& chip : {rig_->label(), rig_->chip_name(), "/dev/" + rig_->chip_name()}) {
    for (const char* line : {"3", "door"}) {
      const auto found = rig_->port().look({chip, line});
      ASSERT_TRUE(found.ok()) << chip << " " << line;
      EXPECT_EQ(found->chip, rig_->chip_name() + " (" + rig_->label() + ")");
      EXPECT_EQ(found->number, 3u);
      EXPECT_EQ(found->name, "door");
      EXPECT_EQ(found->consumer, "");
      EXPECT_FALSE(found->output);
    }
  }
  const auto line = output("door", true);
  EXPECT_TRUE(rig_->is_high(3));
  const auto found = rig_->port().look(name("3"));
  ASSERT_TRUE(found.ok());
  EXPECT_EQ(found->consumer, "zoned");
  EXPECT_TRUE(found->output);
}

TEST_P(GpioLineContract, NamesWhatIsMissingHeldOrOfTheOtherDirection) {
  EXPECT_NE(fault_of({"nosuchchip", "1"}).find("chip nosuchchip: not found"), std::string::npos);
  EXPECT_NE(fault_of({"/dev/nosuchchip", "1"}).find("not found"), std::string::npos);
  EXPECT_NE(fault_of(name("8")).find("line 8 of chip " + rig_->label() + ": the chip has no"),
            std::string::npos);
  EXPECT_NE(fault_of(name("window")).find("no such line"), std::string::npos);
  rig_->occupy(6);
  EXPECT_NE(fault_of(name("6")).find("held by gpioset"), std::string::npos);
  const auto taken = rig_->port().open(GpioOutputSettings{.name = name("6")});
  ASSERT_FALSE(taken.ok());
  EXPECT_EQ(taken.error().code, ErrorCode::kBusy);
  { const auto driven = output("7", false); }
  EXPECT_NE(fault_of(name("7")).find("set up as an output"), std::string::npos);
  EXPECT_TRUE(rig_->port().open(GpioOutputSettings{.name = name("7")}).ok());
  EXPECT_EQ(fault_of(name("5")), "none");
  rig_->add_twin();
  EXPECT_NE(fault_of(name("5")).find("several have this label"), std::string::npos);
  EXPECT_EQ(fault_of({rig_->chip_name(), "5"}), "none");
}

TEST_P(GpioLineContract, ALineGivenBackCanBeOpenedAgain) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(input("4"));
    EXPECT_TRUE(output("1", i == 1));
  }
}

}  // namespace zonepack
