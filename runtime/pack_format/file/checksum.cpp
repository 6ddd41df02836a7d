// SPDX-License-Identifier: Apache-2.0
#include "runtime/pack_format/file/checksum.hpp"

#include <sodium/crypto_generichash_blake2b.h>
#include <xxhash.h>
#if __has_include(<xxh_x86dispatch.h>)
#include <xxh_x86dispatch.h>  // same values, using the widest instructions of this machine
#endif

namespace zonepack {
namespace {

const unsigned char* data_of(ByteSpan bytes) noexcept {
  return reinterpret_cast<const unsigned char*>(bytes.data());
}

}  // namespace

std::uint64_t xxh3(ByteSpan bytes) noexcept { return XXH3_64bits(bytes.data(), bytes.size()); }

Digest16 blake2b_16(ByteSpan bytes) noexcept {
  Digest16 digest{};
  crypto_generichash_blake2b(digest.data(), digest.size(), data_of(bytes), bytes.size(), nullptr,
                             0);
  return digest;
}

Digest32 blake2b_32(std::initializer_list<ByteSpan> parts) noexcept {
  Digest32 digest{};
  crypto_generichash_blake2b_state state;
  crypto_generichash_blake2b_init(&state, nullptr, 0, digest.size());
  for (const ByteSpan& part : parts) {
    crypto_generichash_blake2b_update(&state, data_of(part), part.size());
  }
  crypto_generichash_blake2b_final(&state, digest.data(), digest.size());
  return digest;
}

std::string to_hex(std::span<const std::uint8_t> bytes) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  text.reserve(bytes.size() * 2);
  for (const std::uint8_t byte : bytes) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

}  // namespace zonepack
