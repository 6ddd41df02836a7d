# SPDX-License-Identifier: Apache-2.0
# What is counted in instructions: admission and eviction, for any zone size and any number of zones; recorded cycles.
add_executable(eviction_steps ${CMAKE_CURRENT_LIST_DIR}/eviction_steps.cpp)
zonepack_settings(eviction_steps)
target_link_libraries(eviction_steps PRIVATE zonepack_core)
add_executable(recorded_cycles ${CMAKE_CURRENT_LIST_DIR}/recorded_cycles.cpp)
zonepack_settings(recorded_cycles)
target_link_libraries(recorded_cycles PRIVATE zonepack_runtime)
find_program(VALGRIND valgrind)
if(VALGRIND AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")  # neither runs under the other
  add_test(NAME bench/eviction_steps
           COMMAND ${CMAKE_CURRENT_LIST_DIR}/eviction_steps_test.sh $<TARGET_FILE:eviction_steps>)
endif()
