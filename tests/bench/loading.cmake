# SPDX-License-Identifier: Apache-2.0
# Benchmarks of loading that loading.sh judges.
zonepack_test_program(decode_bench.cpp zonepack_core)
zonepack_test_program(zone_latency.cpp zonepack_runtime)
zonepack_test_program(start_time.cpp zonepack_client)
