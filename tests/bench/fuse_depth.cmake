# SPDX-License-Identifier: Apache-2.0
# Depth images fused into a nvblox map and a point cloud, to measure packs of such maps.
if(TARGET zonepack_localize AND TARGET zonepack_packer)
  find_package(SQLite3 REQUIRED)
  find_package(ZLIB REQUIRED)
  find_package(PNG REQUIRED)
  find_package(JPEG REQUIRED)
  zonepack_measurement(fuse_depth.cpp SQLite::SQLite3 ZLIB::ZLIB PNG::PNG JPEG::JPEG)
endif()
