# SPDX-License-Identifier: Apache-2.0
# Programs of the proofs that toolchains/run prove drives.
zonepack_measurement(memory_watch.cpp zonepack_platform)
zonepack_test_program(map_readers.cpp zonepack_client)
zonepack_measurement(fixed_work.cpp zonepack_runtime)
