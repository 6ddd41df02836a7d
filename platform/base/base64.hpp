// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "platform/base/byte_span.hpp"

namespace zonepack {

// Appends the bytes in base64 (RFC 4648, section 4), padded.
void append_base64(ByteSpan bytes, std::string& text);

}  // namespace zonepack
