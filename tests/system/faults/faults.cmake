# SPDX-License-Identifier: Apache-2.0
# What tests/system/prove/faults.sh works with.
if(TARGET zonepack_packer_test_support)
  add_executable(served_check ${CMAKE_CURRENT_LIST_DIR}/served_check.cpp
                              ${PROJECT_SOURCE_DIR}/tests/system/readers/zone_images.cpp)
  zonepack_settings(served_check)
  target_link_libraries(served_check PRIVATE zonepack_packer_test_support zonepack_client)
  zonepack_test_program(hold_thread.cpp)
endif()
