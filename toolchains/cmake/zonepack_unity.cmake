# SPDX-License-Identifier: Apache-2.0
# With CMAKE_UNITY_BUILD sources are compiled in batches: a fresh build takes a fifth of the time. These have names of
# their own that another file of the same target has too, and are compiled alone.
set(zonepack_alone
  packer/console/command_line.cpp
  packer/commands/export.cpp
  packer/commands/plan.cpp
  packer/commands/prune.cpp
  packer/commands/verify.cpp
  packer/encode/core_chunk_builder.cpp
  packer/encode/pack_writer.cpp
  packer/sources/rtabmap_features.cpp
  packer/sources/rtabmap_links.cpp
  packer/zones/drawn.cpp
  platform/linux/atomic_file.cpp
  runtime/live/check_command.cpp
  runtime/live/live_loader.cpp
  runtime/odometry/det_math.cpp
  runtime/recording/map_block.cpp
  runtime/recording/preface.cpp
  runtime/replay/replay.cpp
  runtime/run/run_files.cpp
  runtime/run/summary_text.cpp
  runtime/report/floor_plan.cpp
  runtime/settings/settings_reference.cpp
  runtime/settings/yaml_section.cpp
  runtime/zones/tracker.cpp
  tests/unit/runtime/memory/residency_test.cpp
  tests/unit/runtime/odometry/canopen_watch_test.cpp
  tests/unit/runtime/odometry/pose_filter_test.cpp
  tests/unit/runtime/odometry/wheel_odometry_test.cpp
  tests/unit/runtime/pack_format/file/checksum_test.cpp
  tests/unit/packer/sources/rtabmap_blobs_test.cpp
  tests/unit/packer/sources/zlib_blob_test.cpp
  tests/unit/packer/zones/split_test.cpp
  tests/unit/packer/verify/lying_manifest_test.cpp
  tests/unit/platform/shared_memory_test.cpp
  tests/unit/platform/sim/sim_wire_test.cpp
  tests/unit/runtime/report/floor_plan_test.cpp
  tests/unit/runtime/report/svg_test.cpp
  tests/unit/runtime/report/ticks_test.cpp
  tests/unit/runtime/live/control_loop_test.cpp
  tests/unit/runtime/recording/flight_recorder_test.cpp
  tests/unit/runtime/recording/recorded_run_test.cpp
  tests/unit/runtime/run/run_report_test.cpp
  tests/unit/runtime/settings/profiles_test.cpp)

function(zonepack_compile_alone)
  list(TRANSFORM zonepack_alone PREPEND ${PROJECT_SOURCE_DIR}/ OUTPUT_VARIABLE files)
  set_source_files_properties(${files} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()
