// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace zonepack {

// What is done before the process stops because a ZP_REQUIRE failed, once, in the thread in which
// it failed: outputs into their safe state. Null: nothing.
void set_last_act(void (*act)() noexcept) noexcept;

}  // namespace zonepack
