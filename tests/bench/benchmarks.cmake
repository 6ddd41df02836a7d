# SPDX-License-Identifier: Apache-2.0
# Benchmarks: run by hand, on a machine that does nothing else. Each says what it compares.

if(ZONEPACK_BUILD_BENCHMARKS)
  add_executable(storage_bench ${CMAKE_CURRENT_LIST_DIR}/storage_bench.cpp)
  zonepack_settings(storage_bench)
  target_link_libraries(storage_bench PRIVATE zonepack_core)
  find_package(benchmark CONFIG REQUIRED)
  add_executable(signal_bench ${CMAKE_CURRENT_LIST_DIR}/signal_bench.cpp)
  zonepack_settings(signal_bench)
  target_link_libraries(signal_bench PRIVATE zonepack_core benchmark::benchmark)
  add_executable(can_frames ${CMAKE_CURRENT_LIST_DIR}/can_frames.cpp)
  zonepack_settings(can_frames)
  target_link_libraries(can_frames PRIVATE zonepack_core)
  if(TARGET zonepack)
    find_package(SQLite3 REQUIRED)
    find_package(ZLIB REQUIRED)
    add_executable(read_unzip_compress ${CMAKE_CURRENT_LIST_DIR}/read_unzip_compress.cpp)
    zonepack_settings(read_unzip_compress)
    target_link_libraries(read_unzip_compress PRIVATE zonepack_pack_format SQLite::SQLite3 ZLIB::ZLIB
                          Threads::Threads)
  endif()
endif()
