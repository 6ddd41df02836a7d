// SPDX-License-Identifier: Apache-2.0
#include "platform/can/can_errors.hpp"

#include <gtest/gtest.h>

namespace zonepack {
namespace {

CanBusStatus after(std::initializer_list<CanFrame> frames) {
  CanBusStatus status;
  for (const CanFrame& frame : frames) take_error_frame(frame, status);
  return status;
}

TEST(CanErrors, FollowTheStateOfTheController) {
  EXPECT_EQ(after({error_frame(kCanErrorController, 0x08)}).state, CanBusState::kWarning);
  EXPECT_EQ(after({error_frame(kCanErrorController, 0x10)}).state, CanBusState::kPassive);
  EXPECT_EQ(
      after({error_frame(kCanErrorController, 0x20), error_frame(kCanErrorController, 0x40)}).state,
      CanBusState::kActive);
}

TEST(CanErrors, CountBusOffAndTheRestartAfterIt) {
  const CanBusStatus off = after({error_frame(kCanErrorBusOff)});
  EXPECT_EQ(off.state, CanBusState::kOff);
  EXPECT_EQ(off.bus_offs, 1u);
  const CanBusStatus on = after({error_frame(kCanErrorBusOff), error_frame(kCanErrorRestarted)});
  EXPECT_EQ(on.state, CanBusState::kActive);
  EXPECT_EQ(on.restarts, 1u);
  EXPECT_EQ(on.error_frames, 2u);
}

TEST(CanErrors, LetBusOffStandOverWhatElseAFrameSays) {
  EXPECT_EQ(after({error_frame(kCanErrorBusOff | kCanErrorController, 0x30)}).state,
            CanBusState::kOff);
}

TEST(CanErrors, CountFramesThatTheControllerLostWithoutAChangeOfState) {
  const CanBusStatus status = after({error_frame(kCanErrorController, 0x10),
                                     error_frame(kCanErrorController, kCanControllerOverflow)});
  EXPECT_EQ(status.overflows, 1u);
  EXPECT_EQ(status.state, CanBusState::kPassive);
}

}  // namespace
}  // namespace zonepack
