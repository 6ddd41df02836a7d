# SPDX-License-Identifier: Apache-2.0
# Tests of the packer as a program.

if(TARGET zonepack)
  find_package(SQLite3 REQUIRED)
  find_package(ZLIB REQUIRED)
  find_package(nlohmann_json CONFIG REQUIRED)

  # Links nothing of the packer: a second opinion about the database.
  add_executable(round_trip_check ${CMAKE_CURRENT_LIST_DIR}/round_trip/round_trip_check.cpp
                 ${CMAKE_CURRENT_LIST_DIR}/round_trip/expected_signature.cpp)
  zonepack_settings(round_trip_check)
  target_link_libraries(round_trip_check PRIVATE SQLite::SQLite3 ZLIB::ZLIB
                        nlohmann_json::nlohmann_json)
  set(zones ${PROJECT_SOURCE_DIR}/tests/data/zones.geojson)
  set(all_payloads features,scan,grid,image,depth,userdata)
  add_test(NAME system/round_trip_hospital_small
           COMMAND round_trip_check $<TARGET_FILE:zonepack>
                   ${PROJECT_SOURCE_DIR}/tests/data/hospital-small.db ${zones} ${all_payloads})
  add_test(NAME system/round_trip_some_payloads
           COMMAND round_trip_check $<TARGET_FILE:zonepack>
                   ${PROJECT_SOURCE_DIR}/tests/data/hospital-small.db ${zones} grid,image)
  add_test(NAME system/round_trip_hospital
           COMMAND round_trip_check $<TARGET_FILE:zonepack> "$ZONEPACK_HOSPITAL_DB" ${zones}
                   ${all_payloads})
  set_tests_properties(system/round_trip_hospital_small system/round_trip_some_payloads
                       system/round_trip_hospital PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 900)

  # A program of its own, because it replaces operator new.
  file(GLOB memory_test_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/memory/*.cpp)
  add_executable(map_memory_test ${memory_test_sources})
  zonepack_settings(map_memory_test)
  target_link_libraries(map_memory_test PRIVATE zonepack_packer_test_support zonepack_packer
                        zonepack_runtime GTest::gtest GTest::gtest_main)
  gtest_discover_tests(map_memory_test TEST_PREFIX "system/" DISCOVERY_TIMEOUT 60)

  file(GLOB build_test_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/build/*.cpp)
  add_executable(build_test ${build_test_sources}
                 ${CMAKE_CURRENT_LIST_DIR}/round_trip/expected_signature.cpp)
  zonepack_settings(build_test)
  target_compile_definitions(build_test PRIVATE ZONEPACK_PROGRAM="$<TARGET_FILE:zonepack>")
  target_link_libraries(build_test PRIVATE zonepack_packer_test_support GTest::gmock GTest::gtest
                        GTest::gtest_main)
  add_dependencies(build_test zonepack)
  gtest_discover_tests(build_test TEST_PREFIX "system/" DISCOVERY_TIMEOUT 60)

  add_test(NAME system/packer_examples
           COMMAND python3 ${CMAKE_CURRENT_LIST_DIR}/packer_examples_test.py $<TARGET_FILE:zonepack>
                   ${PROJECT_SOURCE_DIR}/tests/data)
  add_test(NAME system/packer_hints
           COMMAND python3 ${CMAKE_CURRENT_LIST_DIR}/packer_hints_test.py $<TARGET_FILE:zonepack>
                   ${PROJECT_SOURCE_DIR})
  add_test(NAME system/update
           COMMAND ${CMAKE_CURRENT_LIST_DIR}/update_test.sh ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
  set_tests_properties(system/update PROPERTIES TIMEOUT 300)
  set_tests_properties(system/packer_examples system/packer_hints PROPERTIES TIMEOUT 300)
  add_test(NAME system/stella
           COMMAND python3 ${CMAKE_CURRENT_LIST_DIR}/sources/stella_test.py ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
  add_test(NAME system/clouds
           COMMAND python3 ${CMAKE_CURRENT_LIST_DIR}/sources/cloud_test.py ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
  add_test(NAME system/update_kinds
           COMMAND python3 ${CMAKE_CURRENT_LIST_DIR}/sources/update_kinds_test.py ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
  add_executable(zone_blocks ${CMAKE_CURRENT_LIST_DIR}/sources/zone_blocks.cpp)
  zonepack_settings(zone_blocks)
  target_link_libraries(zone_blocks PRIVATE zonepack_packer_test_support zonepack_client)
  add_test(NAME system/nvblox
           COMMAND python3 ${CMAKE_CURRENT_LIST_DIR}/sources/nvblox_test.py ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
  add_test(NAME system/slice
           COMMAND python3 ${CMAKE_CURRENT_LIST_DIR}/sources/slice_test.py ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
  add_test(NAME system/three_lines
           COMMAND python3 ${CMAKE_CURRENT_LIST_DIR}/sources/three_lines_test.py ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
  add_test(NAME system/suggest_limits
           COMMAND python3 ${CMAKE_CURRENT_LIST_DIR}/suggest_limits_test.py ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
  set_tests_properties(system/stella system/clouds system/update_kinds system/nvblox system/slice system/three_lines
                       system/suggest_limits PROPERTIES TIMEOUT 600)
endif()

if(TARGET zonepack)
  add_test(NAME system/old_reader
           COMMAND python3 ${CMAKE_CURRENT_LIST_DIR}/old_reader_test.py ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
endif()

if(TARGET zonepack AND TARGET zoned)
  add_test(NAME system/drive_kinds
           COMMAND python3 ${CMAKE_CURRENT_LIST_DIR}/sources/drive_test.py ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
  set_tests_properties(system/drive_kinds PROPERTIES TIMEOUT 600)
  add_test(NAME system/suggest_zones
           COMMAND ${CMAKE_CURRENT_LIST_DIR}/suggest_zones_test.sh ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
  add_test(NAME system/tune
           COMMAND ${CMAKE_CURRENT_LIST_DIR}/tune_test.sh ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
  set_tests_properties(system/suggest_zones system/tune PROPERTIES TIMEOUT 600)
endif()

# Files that are right and do not fit each other: what is said of them.
if(TARGET zonepack AND TARGET zoned)
  add_test(NAME system/misfits
           COMMAND python3 ${CMAKE_CURRENT_LIST_DIR}/misfits_test.py ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
                   ${PROJECT_SOURCE_DIR})
endif()

# Maps that ask for more memory than the budget: at start, at SIGHUP, and after the refusal.
if(TARGET zonepack AND TARGET zoned)
  zonepack_test_program(hostile/make_hostile_map.cpp zonepack_packer_test_support)
  add_test(NAME system/hostile_maps
           COMMAND python3 ${CMAKE_CURRENT_LIST_DIR}/hostile/hostile_maps_test.py
                   ${CMAKE_RUNTIME_OUTPUT_DIRECTORY} ${PROJECT_SOURCE_DIR}
                   $<TARGET_FILE:make_hostile_map>)
  set_tests_properties(system/hostile_maps PROPERTIES TIMEOUT 600)
endif()
