// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "platform/base/failure.hpp"
#include "runtime/settings/dbc_unit.hpp"
#include "runtime/settings/settings.hpp"

// What the units of a DBC file are in those of the section odometry.
namespace zonepack {

// What the signals of a unit measure, as a unit of a DBC file.
DbcUnit as_dbc_unit(WheelUnit unit);

bool is_percent(const std::string& text);

// What a wheel's unit in the DBC file is in units of `odometry`; 1 when both agree.
Outcome<double> wheel_conversion(const OdometrySettings& odometry, const std::string& text);

// The same for what is not a wheel: steering (rad), yaw rate (rad/s), a twist's forward speed
// (m/s).
Outcome<double> si_of(const OdometrySettings& odometry, const std::string& key,
                      const std::string& text);

}  // namespace zonepack
