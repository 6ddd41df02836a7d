# SPDX-License-Identifier: Apache-2.0
# Benchmarks of loading that loading.sh judges.
add_executable(decode_bench ${CMAKE_CURRENT_LIST_DIR}/decode_bench.cpp)
zonepack_settings(decode_bench)
target_link_libraries(decode_bench PRIVATE zonepack_core)
add_executable(zone_latency ${CMAKE_CURRENT_LIST_DIR}/zone_latency.cpp)
zonepack_settings(zone_latency)
target_link_libraries(zone_latency PRIVATE zonepack_runtime)
add_executable(start_time ${CMAKE_CURRENT_LIST_DIR}/start_time.cpp)
zonepack_settings(start_time)
target_link_libraries(start_time PRIVATE zonepack_client)
