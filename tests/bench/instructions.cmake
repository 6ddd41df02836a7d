# SPDX-License-Identifier: Apache-2.0
# What is counted in instructions: admission and eviction, for any zone size and any number of zones; recorded cycles.
zonepack_measurement(recorded_cycles.cpp zonepack_runtime)
find_program(VALGRIND valgrind)
if(VALGRIND AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")  # neither runs under the other
  zonepack_test_program(eviction_steps.cpp zonepack_core)
  zonepack_test_program(expected_steps.cpp zonepack_core)
  add_test(NAME bench/eviction_steps
           COMMAND ${CMAKE_CURRENT_LIST_DIR}/eviction_steps_test.sh $<TARGET_FILE:eviction_steps>)
  add_test(NAME bench/expected_steps
           COMMAND ${CMAKE_CURRENT_LIST_DIR}/expected_steps_test.sh $<TARGET_FILE:expected_steps>)
endif()
