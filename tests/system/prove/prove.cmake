# SPDX-License-Identifier: Apache-2.0
# Programs of the proofs that toolchains/run prove drives.
add_executable(memory_watch ${CMAKE_CURRENT_LIST_DIR}/memory_watch.cpp)
zonepack_settings(memory_watch)
target_link_libraries(memory_watch PRIVATE zonepack_platform)
add_executable(map_readers ${CMAKE_CURRENT_LIST_DIR}/map_readers.cpp)
zonepack_settings(map_readers)
target_link_libraries(map_readers PRIVATE zonepack_client)
add_executable(fixed_work ${CMAKE_CURRENT_LIST_DIR}/fixed_work.cpp)
zonepack_settings(fixed_work)
target_link_libraries(fixed_work PRIVATE zonepack_runtime)
