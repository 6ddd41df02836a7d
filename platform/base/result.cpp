// SPDX-License-Identifier: Apache-2.0
#include "platform/base/result.hpp"

namespace zonepack {

const char* to_string(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::kOk:
      return "ok";
    case ErrorCode::kNotFound:
      return "not found";
    case ErrorCode::kIo:
      return "i/o error";
    case ErrorCode::kTooLarge:
      return "too large";
    case ErrorCode::kTruncated:
      return "truncated";
    case ErrorCode::kBadMagic:
      return "wrong kind of file";
    case ErrorCode::kBadVersion:
      return "unknown format version";
    case ErrorCode::kBadChecksum:
      return "bad checksum";
    case ErrorCode::kBadCompression:
      return "bad compressed block";
    case ErrorCode::kBadStructure:
      return "bad structure";
    case ErrorCode::kBadValue:
      return "bad value";
    case ErrorCode::kMismatch:
      return "mismatch";
    case ErrorCode::kExists:
      return "already exists";
    case ErrorCode::kBusy:
      return "busy";
    case ErrorCode::kNoRoom:
      return "no room";
    case ErrorCode::kCancelled:
      return "cancelled";
    case ErrorCode::kUsage:
      return "wrong usage";
  }
  return "unknown error";
}

}  // namespace zonepack
