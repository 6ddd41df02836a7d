// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/rtabmap/zlib_blob.hpp"

#include <array>
#include <cstring>
#include <new>

namespace zonepack::packer {
namespace {

constexpr std::array<std::uint32_t, 7> kDepthBytes = {1, 1, 2, 2, 4, 4, 8};
constexpr std::array<const char*, 7> kDepthNames = {"uint8", "int8",    "uint16", "int16",
                                                    "int32", "float32", "float64"};
constexpr std::size_t kTrailerBytes = 12;
// Deflate expands two bits to at most 258 bytes.
constexpr std::uint64_t kDeflateMostExpansion = 1032;

std::uint32_t channels_of(std::int32_t type) { return (static_cast<std::uint32_t>(type) >> 3) + 1; }

std::string describe(const Matrix& matrix) {
  return std::to_string(matrix.rows) + " x " + std::to_string(matrix.cols) + " of " +
         describe_type(matrix.type);
}

}  // namespace

std::uint32_t element_bytes(std::int32_t type) noexcept {
  const auto depth = static_cast<std::uint32_t>(type) & 7;
  if (type < 0 || type > 0xfff || depth >= kDepthBytes.size()) return 0;
  return kDepthBytes[depth] * channels_of(type);
}

std::string describe_type(std::int32_t type) {
  if (element_bytes(type) == 0) return "unknown type " + std::to_string(type);
  return std::to_string(channels_of(type)) + " x " +
         kDepthNames[static_cast<std::uint32_t>(type) & 7];
}

MatrixUnpacker::MatrixUnpacker() {
  if (inflateInit(&stream_) != Z_OK) throw std::bad_alloc();
}

MatrixUnpacker::~MatrixUnpacker() { inflateEnd(&stream_); }

void MatrixUnpacker::unpack(std::span<const std::byte> blob, const CellPlace& place, Matrix& out) {
  if (blob.size() <= kTrailerBytes) {
    place.damaged("expected a compressed matrix (zlib stream and 12 bytes of size), found " +
                  std::to_string(blob.size()) + " bytes");
  }
  const std::size_t zipped = blob.size() - kTrailerBytes;
  std::array<std::int32_t, 3> trailer;
  std::memcpy(trailer.data(), blob.data() + zipped, kTrailerBytes);
  out.rows = trailer[0];
  out.cols = trailer[1];
  out.type = trailer[2];
  const std::uint64_t element = element_bytes(out.type);
  if (out.rows < 0 || out.cols < 0 || element == 0) {
    place.damaged("expected rows, columns and OpenCV type at its end, found " + describe(out));
  }
  const std::uint64_t elements =
      static_cast<std::uint64_t>(out.rows) * static_cast<std::uint64_t>(out.cols);
  if (elements > kLargestMatrixBytes / element) {
    place.damaged("declares " + describe(out) + ", over the limit of 256 MiB");
  }
  const std::uint64_t bytes = elements * element;
  if (bytes > (zipped + 1) * kDeflateMostExpansion) {
    place.damaged("declares " + describe(out) + ", more than " + std::to_string(zipped) +
                  " zipped bytes can hold");
  }
  out.data.resize(static_cast<std::size_t>(bytes));

  // zlib needs a valid pointer even for an empty result.
  std::byte nothing{};
  inflateReset(&stream_);
  stream_.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(blob.data()));
  stream_.avail_in = static_cast<uInt>(zipped);
  stream_.next_out = reinterpret_cast<Bytef*>(bytes != 0 ? out.data.data() : &nothing);
  stream_.avail_out = static_cast<uInt>(bytes);
  const int code = inflate(&stream_, Z_FINISH);
  if (code == Z_MEM_ERROR) throw std::bad_alloc();
  if (code == Z_STREAM_END && stream_.avail_out == 0 && stream_.avail_in == 0) return;
  if (code == Z_STREAM_END) {
    const std::string after =
        stream_.avail_in == 0 ? "" : " and " + std::to_string(stream_.avail_in) + " bytes after it";
    place.damaged("expected " + describe(out) + " (" + std::to_string(bytes) +
                  " bytes), found a zlib stream of " + std::to_string(stream_.total_out) +
                  " bytes" + after);
  }
  if (stream_.avail_out == 0 && code != Z_DATA_ERROR) {
    place.damaged("expected " + describe(out) + " (" + std::to_string(bytes) +
                  " bytes), found a longer zlib stream");
  }
  place.damaged("expected a whole zlib stream of " + describe(out) + ", found " +
                (stream_.msg != nullptr ? stream_.msg : "one cut short"));
}

}  // namespace zonepack::packer
