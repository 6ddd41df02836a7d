// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/cloud/lzf_stream.hpp"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <vector>

namespace zonepack::packer {
namespace {

// A literal run is a byte n < 32 and n + 1 bytes. A match is three bits of length (7: one more
// byte), thirteen of distance: up to 264 bytes from at most 8192 back.
class LzfDecoder {
 public:
  LzfDecoder(std::FILE* in, std::uint64_t stored, std::FILE* out, std::uint64_t whole,
             const std::string& name)
      : in_(in), left_(stored), out_(out), whole_(whole), name_(name), window_(kWindow) {}

  void run() {
    while (left_ > 0) {
      const unsigned control = byte();
      if (control < 32) {
        for (unsigned i = 0; i <= control; ++i) put(static_cast<char>(byte()));
        continue;
      }
      unsigned length = control >> 5;
      if (length == 7) length += byte();
      const std::uint64_t back = ((control & 31U) << 8 | byte()) + std::uint64_t{1};
      if (back > written_) fail("refers to bytes before its first");
      for (unsigned i = 0; i < length + 2; ++i) put(window_[(written_ - back) % kWindow]);
    }
    if (written_ != whole_) fail("is shorter than it says");
    flush();
  }

 private:
  static constexpr std::size_t kWindow = 64 << 10;

  [[noreturn]] void fail(const std::string& problem) const {
    throw std::runtime_error(
        name_ + ": its compressed data " + problem +
        "; copy the file again, or convert it with pcl_convert_pcd_ascii_binary");
  }

  unsigned byte() {
    const int c = left_ == 0 ? EOF : std::getc(in_);
    if (c == EOF) fail("ends too early");
    --left_;
    return static_cast<unsigned>(c);
  }

  void put(char c) {
    if (written_ == whole_) fail("is longer than it says");
    window_[written_ % kWindow] = c;
    if (++written_ % kWindow == 0) write(kWindow);
  }

  void flush() { write(written_ % kWindow); }

  void write(std::size_t bytes) {
    if (std::fwrite(window_.data(), 1, bytes, out_) == bytes) return;
    throw std::runtime_error(name_ + ": the temporary file for its points cannot be written: " +
                             std::strerror(errno) + "; make room, or set TMPDIR to another disk");
  }

  std::FILE* in_;
  std::uint64_t left_;
  std::FILE* out_;
  std::uint64_t whole_, written_ = 0;
  const std::string& name_;
  std::vector<char> window_;
};

}  // namespace

void decompress_lzf(std::FILE* in, std::uint64_t stored, std::FILE* out, std::uint64_t whole,
                    const std::string& name) {
  LzfDecoder(in, stored, out, whole, name).run();
  if (std::fflush(out) != 0)
    throw std::runtime_error(name + ": the temporary file cannot be written");
}

}  // namespace zonepack::packer
