// SPDX-License-Identifier: Apache-2.0
#include "runtime/listen/listener.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/listen/listen_text.hpp"

namespace zonepack {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr std::int64_t kMs = 1'000'000;

// Two wheels in millimetres in one frame, and a battery that odometry does not read.
const char* const kYaml =
    "can:\n"
    "  signals:\n"
    "    l: {id: 0x10, start: 0, length: 16, type: signed, factor: 0.001}\n"
    "    r: {id: 0x10, start: 16, length: 16, type: signed, factor: 0.001}\n"
    "    battery: {id: 0x20, start: 0, length: 8, factor: 0.5, offset: 10}\n"
    "odometry: {model: differential-positions, left: l, right: r, track: 0.5, timeout: 0.1}\n";

CanFrame wheels(std::int64_t at_ns, int left_mm, int right_mm) {
  CanFrame frame;
  frame.stamp_ns = at_ns;
  frame.id = 0x10;
  frame.len = 4;
  const auto put = [&frame](std::size_t at, int value) {
    frame.data[at] = static_cast<std::uint8_t>(value & 0xFF);
    frame.data[at + 1] = static_cast<std::uint8_t>(value >> 8 & 0xFF);
  };
  put(0, left_mm);
  put(2, right_mm);
  return frame;
}

CanFrame other(std::int64_t at_ns, std::uint32_t id, std::uint8_t value) {
  CanFrame frame;
  frame.stamp_ns = at_ns;
  frame.id = id;
  frame.len = 1;
  frame.data[0] = value;
  return frame;
}

class ListenerTest : public testing::Test {
 protected:
  // 0.5 m/s straight on for a second: 5 mm every 10 ms.
  void drive_straight() {
    for (int i = 0; i <= 100; ++i) listener_.take(wheels(i * 10 * kMs, 100 + 5 * i, 5 * i));
  }

  const Settings settings_ = parse_settings(kYaml, "robot.yaml").settings;
  Listener listener_{settings_, {}, std::nullopt};
};

TEST_F(ListenerTest, ShowsEachSignalWithRawValueRateAndAge) {
  drive_straight();
  listener_.take(other(1000 * kMs, 0x20, 28));
  const ListenPicture picture = listener_.picture(1050 * kMs, true);
  ASSERT_EQ(picture.rows.size(), 3u);
  const ListenPicture::Row& left = picture.rows[0];
  EXPECT_EQ(left.signal->key, "left");
  EXPECT_EQ(left.signal->unit, "m");
  EXPECT_EQ(left.raw, 600);
  EXPECT_DOUBLE_EQ(left.value, 0.6);
  EXPECT_NEAR(left.rate_hz, 100, 1e-6);
  EXPECT_NEAR(left.age_s, 0.05, 1e-9);
  EXPECT_EQ(left.state, SignalState::kFresh);
  EXPECT_NEAR(left.speed_m_s, 0.5, 1e-9);
  EXPECT_NEAR(left.moved_m, 0.5, 1e-9);
  const ListenPicture::Row& battery = picture.rows[2];
  EXPECT_EQ(battery.signal->key, "");
  EXPECT_EQ(battery.value, 24);  // 28 * 0.5 + 10
  EXPECT_NEAR(picture.distance_m, 0.5, 1e-9);
  EXPECT_NEAR(picture.speed_m_s, 0.5, 1e-9);
  EXPECT_NEAR(picture.pose.x_m, 0.5, 1e-9);
  EXPECT_EQ(picture.samples, 100u);
  EXPECT_TRUE(listener_.heard_odometry());
}

TEST_F(ListenerTest, ASignalIsNeverSeenFreshStaleOrUnreadable) {
  EXPECT_EQ(listener_.picture(0, false).rows[0].state, SignalState::kNeverSeen);
  EXPECT_FALSE(listener_.heard_odometry());
  listener_.take(wheels(0, 1, 1));
  EXPECT_EQ(listener_.picture(100 * kMs, false).rows[0].state, SignalState::kFresh);
  EXPECT_EQ(listener_.picture(101 * kMs, false).rows[0].state, SignalState::kStale);
  CanFrame cut = wheels(110 * kMs, 2, 2);
  cut.len = 2;  // still holds the left wheel
  listener_.take(cut);
  const ListenPicture picture = listener_.picture(110 * kMs, false);
  EXPECT_EQ(picture.rows[0].state, SignalState::kFresh);
  EXPECT_EQ(picture.rows[1].state, SignalState::kUnreadable);
  EXPECT_EQ(picture.refused, 1u);
  EXPECT_THAT(picture.refused_why, HasSubstr("1 too short"));
}

TEST_F(ListenerTest, ASpeedBeyondTheLimitsIsOutOfRange) {
  const Settings speeds =
      parse_settings(
          "can: {signals: {l: {id: 1, start: 0, length: 8}, r: {id: 1, start: 8, "
          "length: 8}}}\n"
          "odometry: {model: wheel-speeds, left: l, right: r, track: 0.5, "
          "max_speed: 3, max_yaw_rate: 2}\n",
          "robot.yaml")
          .settings;
  Listener listener(speeds, {}, std::nullopt);
  // 3 m/s and half of 0.5 m at 2 rad/s: 3.5 m/s.
  CanFrame frame = other(0, 1, 3);
  frame.len = 2;
  frame.data[1] = 4;
  listener.take(frame);
  const ListenPicture picture = listener.picture(0, false);
  EXPECT_EQ(picture.rows[0].signal->unit, "m/s");
  EXPECT_EQ(picture.rows[0].state, SignalState::kFresh);
  EXPECT_EQ(picture.rows[1].state, SignalState::kOutOfRange);
}

TEST_F(ListenerTest, IdsThatNoSettingNamesAreListedTheMostFrequentFirst) {
  for (std::uint32_t id = 0x100; id < 0x108; ++id) listener_.take(other(0, id, 0));
  for (int i = 1; i <= 10; ++i) listener_.take(other(i * 20 * kMs, 0x105, 0));
  const ListenPicture picture = listener_.picture(200 * kMs, true);
  ASSERT_EQ(picture.others.size(), Listener::kMostOthers);
  EXPECT_EQ(picture.others[0].id.id, 0x105u);
  EXPECT_EQ(picture.others[0].count, 11u);
  EXPECT_NEAR(picture.others[0].rate_hz, 50, 1e-6);
  EXPECT_EQ(picture.further_ids, 2u);
}

TEST_F(ListenerTest, ARateFallsWhileNothingComes) {
  drive_straight();
  EXPECT_NEAR(listener_.picture(1010 * kMs, false).rows[0].rate_hz, 100, 1e-6);
  // The newest 64 samples spread over 0.63 s; 2 s of silence, less two periods: 63 / 2.61 s.
  EXPECT_NEAR(listener_.picture(3000 * kMs, false).rows[0].rate_hz, 63 / 2.61, 1e-6);
}

TEST_F(ListenerTest, TheTextNamesWhatIsMissingAndFitsATerminal) {
  drive_straight();
  const std::string text = listen_text(listener_.picture(1000 * kMs, true), {.source = "a.log"});
  EXPECT_THAT(text, HasSubstr("a.log: 1.0 s, 101 frames\n"));
  EXPECT_THAT(text, HasSubstr("-      -        0x020  battery"));
  EXPECT_THAT(text, HasSubstr("never seen\n"));
  EXPECT_THAT(text, HasSubstr("wheels    left +0.50 m/s (+0.50 m so far)"));
  EXPECT_THAT(text, HasSubstr("compare   with nothing: use --expect forward"));
  EXPECT_THAT(text, Not(HasSubstr("hint:")));
  EXPECT_EQ(fitted("\x1b[32mfresh\x1b[0m\n123456 8\n\n", 5, 9),
            "\x1b[32mfresh\x1b[0m\n12345\n6 8\n\n");
  EXPECT_EQ(fitted("one two three\n", 8, 9), "one two\nthree\n");
  EXPECT_EQ(fitted("1\n2\n3\n", 80, 2), "1\n2\n");
  EXPECT_EQ(printable("a\x1b[2J\xB0\xC2\xB0"), "a?[2J?\xC2\xB0");
}

TEST_F(ListenerTest, WhatSomebodyDoesIsComparedWithTheWheels) {
  Listener listener(settings_, {}, parse_expected_motion("left"));
  for (int i = 0; i <= 100; ++i) listener.take(wheels(i * 10 * kMs, 2 * i, -2 * i));
  const auto hints = listener.picture(1000 * kMs, true).hints;
  ASSERT_EQ(hints.size(), 1u);
  EXPECT_EQ(hints[0].kind, "swapped");
}

TEST_F(ListenerTest, AnAmountIsJudgedOnceTheRobotStands) {
  Listener listener(settings_, {}, parse_expected_motion("forward=2"));
  EXPECT_THAT(listener.picture(0, false).hints, IsEmpty());
  for (int i = 0; i <= 100; ++i) listener.take(wheels(i * 10 * kMs, 5 * i, 5 * i));
  EXPECT_THAT(listener.picture(1000 * kMs, false).hints, IsEmpty());
  for (int i = 101; i <= 200; ++i) listener.take(wheels(i * 10 * kMs, 500, 500));
  const auto hints = listener.picture(2000 * kMs, false).hints;
  ASSERT_EQ(hints.size(), 1u);
  EXPECT_THAT(hints[0].text, HasSubstr("0.5 m of 2 m"));
}

}  // namespace
}  // namespace zonepack
