// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace zonepack::packer {

struct CloudPoint {
  double x = 0, y = 0, z = 0;  // metres, in the file's frame
  float intensity = 0, ring = 0;
  std::uint32_t rgb = 0;  // 0x00RRGGBB
};

// What a file's points have besides x, y, z, and what of it is carried.
struct CloudFields {
  bool wide = false;  // coordinates are float64
  bool intensity = false, rgb = false, ring = false;
  std::vector<std::string> dropped;  // names of fields that are not carried
  bool operator==(const CloudFields&) const = default;
  // Of 4 bytes, that a point is packed in.
  std::size_t words() const noexcept {
    return 3U + (intensity ? 1U : 0U) + (rgb ? 1U : 0U) + (ring ? 1U : 0U);
  }
};

// The points of one file, one after the other, in constant memory. Throws std::runtime_error with
// the file's name where it is not whole.
class PointStream {
 public:
  virtual ~PointStream() = default;
  virtual const CloudFields& fields() const noexcept = 0;
  // The number that the file claims.
  virtual std::uint64_t size() const noexcept = 0;
  // False at the end.
  virtual bool next(CloudPoint& point) = 0;
};

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;
// Opens for reading; throws with the reason.
File open_file(const std::string& path);

}  // namespace zonepack::packer
