# SPDX-License-Identifier: Apache-2.0
# Benchmarks of loading that loading.sh judges.
zonepack_measurement(decode_bench.cpp zonepack_core)
zonepack_measurement(zone_latency.cpp zonepack_runtime)
zonepack_measurement(start_time.cpp zonepack_client)
