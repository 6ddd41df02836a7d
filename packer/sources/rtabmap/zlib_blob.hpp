// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "packer/record/damage.hpp"
#include "packer/record/record.hpp"

namespace zonepack::packer {

// Bytes of one element (all channels) of an OpenCV type; 0 when there is no such type.
std::uint32_t element_bytes(std::int32_t type) noexcept;

// "2 x float32" for an OpenCV type, for messages.
std::string describe_type(std::int32_t type);

// Reads RTAB-Map's compressed matrices: a zlib stream, then rows, columns and OpenCV type as three
// int32 at the very end. Keeps its working memory, so use one object for many blobs.
//
// Threads: one.
class MatrixUnpacker {
 public:
  MatrixUnpacker();
  ~MatrixUnpacker();
  MatrixUnpacker(const MatrixUnpacker&) = delete;
  MatrixUnpacker& operator=(const MatrixUnpacker&) = delete;

  // Unzips `blob` into `out`, whose memory is reused. The declared size is checked against the
  // limit and against what the stream can hold before any memory is allocated. Throws through
  // `place` when the stream is not whole, does not have exactly the declared size, or is followed
  // by other bytes.
  void unpack(std::span<const std::byte> blob, const CellPlace& place, Matrix& out);

 private:
  z_stream stream_{};
};

}  // namespace zonepack::packer
