# SPDX-License-Identifier: Apache-2.0
# Debian arm64. ZONEPACK_CPU: cortex-a53, cortex-a72, cortex-a78ae, …
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(debian_arch arm64)
set(debian_triplet aarch64-linux-gnu)
set(debian_qemu qemu-aarch64-static)
set(debian_flags "")
include(${CMAKE_CURRENT_LIST_DIR}/debian_cross.cmake)
