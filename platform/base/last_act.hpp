// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace zonepack {

// Sets what runs once, on the failing thread, before a failed ZP_REQUIRE stops the process: it puts
// outputs into their safe state. Null: nothing runs.
void set_last_act(void (*act)() noexcept) noexcept;

// Runs it now, for a process that ends without its destructors. Later calls do nothing.
void run_last_act() noexcept;

}  // namespace zonepack
