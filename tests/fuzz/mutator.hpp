// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <random>

#include "packer/record/record.hpp"

namespace zonepack::fuzz {

// Changes bytes the way that finds most: bits, whole numbers at their limits, pieces moved and cut.
// The same seed gives the same changes on every machine.
class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : engine_(seed) {}

  packer::Bytes operator()(packer::Bytes bytes) {
    for (std::size_t changes = 1 + below(3); changes > 0 && !bytes.empty(); --changes) {
      change(bytes);
    }
    return bytes;
  }

 private:
  std::size_t below(std::size_t limit) { return static_cast<std::size_t>(engine_() % limit); }

  void change(packer::Bytes& bytes) {
    const std::size_t at = below(bytes.size());
    switch (below(6)) {
      case 0:
        bytes[at] ^= static_cast<std::byte>(1u << below(8));
        return;
      case 1:
        bytes[at] = static_cast<std::byte>(below(256));
        return;
      case 2: {
        static constexpr std::uint32_t kEnds[] = {0,          1,          0xFF,       0xFFFF,
                                                  0x01000000, 0x3FFFFFFF, 0x40000000, 0x7FFFFFFF,
                                                  0x80000000, 0xFFFFFFFE, 0xFFFFFFFF};
        const std::uint32_t value = kEnds[below(std::size(kEnds))];
        const std::size_t word = at / 4 * 4;
        std::memcpy(&bytes[word], &value, std::min<std::size_t>(4, bytes.size() - word));
        return;
      }
      case 3: {  // a number a little larger or smaller
        const std::size_t word = at / 4 * 4;
        if (bytes.size() - word < 4) return;
        std::uint32_t value;
        std::memcpy(&value, &bytes[word], 4);
        value += static_cast<std::uint32_t>(below(33)) - 16;
        std::memcpy(&bytes[word], &value, 4);
        return;
      }
      case 4: {
        const std::size_t from = below(bytes.size());
        const std::size_t size = std::min({1 + below(32), bytes.size() - at, bytes.size() - from});
        std::memmove(&bytes[at], &bytes[from], size);
        return;
      }
      default:
        if (below(8) == 0) bytes.resize(at);
    }
  }

  std::mt19937_64 engine_;
};

}  // namespace zonepack::fuzz
