// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "packer/record/record.hpp"

namespace zonepack::packer {

// Appends values of a fixed or changing width as a bit string, least significant bit first.
class BitWriter {
 public:
  explicit BitWriter(Bytes& out) : out_(out) {}
  void put(std::uint32_t value, unsigned width) {
    word_ |= std::uint64_t{value} << filled_;
    filled_ += width;
    while (filled_ >= 8) {
      out_.push_back(static_cast<std::byte>(word_ & 0xFF));
      word_ >>= 8;
      filled_ -= 8;
    }
  }
  void finish() {
    if (filled_ > 0) out_.push_back(static_cast<std::byte>(word_ & 0xFF));
    word_ = 0;
    filled_ = 0;
  }

 private:
  Bytes& out_;
  std::uint64_t word_ = 0;
  unsigned filled_ = 0;
};

}  // namespace zonepack::packer
