// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

namespace zonepack::packer {

// Decompresses `stored` bytes of an LZF stream (Marc Lehmann's LibLZF, as PCD files hold it) from
// `in`, at its place, to `out`, and expects exactly `whole` bytes. Debian's liblzf decompresses
// from memory into memory only; a cloud may be larger than that.
//
// Errors: std::runtime_error that names `name`.
// Memory: a window of 64 KiB.
void decompress_lzf(std::FILE* in, std::uint64_t stored, std::FILE* out, std::uint64_t whole,
                    const std::string& name);

}  // namespace zonepack::packer
