# SPDX-License-Identifier: Apache-2.0
# Debian armhf: ARMv7 with VFPv3. Times and file sizes have 64 bits, as on the other architectures; libraries of
# Debian 12 still have 32, so no time_t, timespec or off_t may cross into one of theirs (libgpiod's events do).
# Sizes that the format bounds are 64 bits long everywhere and narrow here to size_t: warnings, not errors.
# -Wno-psabi: g++ notes calls that changed with GCC 7.
set(CMAKE_SYSTEM_PROCESSOR armv7l)
set(debian_arch armhf)
set(debian_triplet arm-linux-gnueabihf)
set(debian_qemu qemu-arm-static)
set(debian_flags "-D_FILE_OFFSET_BITS=64 -D_TIME_BITS=64 -Wno-psabi -Wno-error=conversion -Wno-error=narrowing")
include(${CMAKE_CURRENT_LIST_DIR}/debian_cross.cmake)
