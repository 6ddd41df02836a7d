// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

namespace zonepack::packer {

// The header of a PCD file (0.6 and 0.7).
struct PcdHeader {
  struct Field {
    std::string name;
    char type = 'F';           // F float, I signed, U unsigned
    std::uint32_t size = 4;    // bytes: 1, 2, 4, 8
    std::uint32_t count = 1;   // elements
    std::uint64_t offset = 0;  // in a record, bytes
  };
  enum class Data : std::uint8_t { kAscii, kBinary, kCompressed };

  std::vector<Field> fields;
  std::uint64_t points = 0;
  std::uint64_t record_bytes = 0;
  std::array<double, 7> viewpoint = {0, 0, 0, 1, 0, 0, 0};  // x, y, z, qw, qx, qy, qz
  Data data = Data::kAscii;

  // The only field of one of these names, if there is one of one element.
  const Field* find(std::initializer_list<const char*> names) const;
  bool moved() const { return viewpoint != std::array<double, 7>{0, 0, 0, 1, 0, 0, 0}; }
};

// Whether bytes begin as a PCD file does.
bool begins_as_pcd(std::string_view bytes);

// Reads the header and leaves `file` at the first byte behind it. Throws std::runtime_error with
// the file and line; at most 64 KiB are read, at most 64 fields taken.
PcdHeader read_pcd_header(std::FILE* file, const std::string& name);

}  // namespace zonepack::packer
