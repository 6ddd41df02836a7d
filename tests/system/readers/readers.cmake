# SPDX-License-Identifier: Apache-2.0
# Eight readers of the shared memory, three of which misbehave. `readers_proof 100000` is the proof; the
# test is the same with fewer evictions.
if(TARGET zonepack_packer_test_support)
  file(GLOB readers_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/*.cpp)
  add_executable(readers_proof ${readers_sources})
  zonepack_settings(readers_proof)
  target_link_libraries(readers_proof PRIVATE zonepack_packer_test_support zonepack_client)
  add_test(NAME system/eight_readers COMMAND readers_proof 20000)
endif()
