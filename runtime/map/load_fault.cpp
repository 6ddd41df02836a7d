// SPDX-License-Identifier: Apache-2.0
#include "runtime/map/load_fault.hpp"

#include <cerrno>
#include <system_error>

#include "runtime/map/loader.hpp"

namespace zonepack {
namespace {

constexpr const char* kCopyAgain =
    "; build the map again or copy the pack again, zonepack verify shows what is damaged";

std::string system_words(std::int64_t number) {
  return std::generic_category().message(static_cast<int>(number));
}

std::string what_to_do(Error error) {
  if (error.code != ErrorCode::kIo) return kCopyAgain;
  switch (error.detail) {
    case EACCES:
    case EPERM:
      return "; let the user that zoned runs as read the map's folder and packs";
    case EMFILE:
    case ENFILE:
      return "; too many files are open, raise the limit (LimitNOFILE)";
    default:
      return "; look after the disk (dmesg shows what it said), then copy the map again";
  }
}

std::string what_was_found(Error error) {
  const std::string detail = std::to_string(error.detail);
  switch (error.code) {
    case ErrorCode::kIo:
      return std::string(to_string(error.code)) + ": " + system_words(error.detail);
    case ErrorCode::kNotFound:
      return to_string(error.code);
    case ErrorCode::kTruncated:
      return "truncated: the file ends at byte " + detail;
    case ErrorCode::kTooLarge:
      if (const auto excess = excess_of(error)) return to_string(*excess);
      return "its index takes " + detail +
             " bytes, more than the chunks that the manifest counts in it";
    case ErrorCode::kMismatch:
      if (error.detail == kFalseClaim) {
        return "mismatch: it has other signatures, slots or chunks than the manifest says";
      }
      return "mismatch: it is not the pack that the manifest names";
    case ErrorCode::kBadChecksum:
    case ErrorCode::kBadCompression:
    case ErrorCode::kBadStructure:
      return std::string(to_string(error.code)) + " at byte " + detail;
    default:
      return std::string(to_string(error.code)) + " (" + detail + ")";
  }
}

}  // namespace

std::string load_fault(const Catalog& catalog, ZoneId zone, Error error) {
  const CatalogZone& known = catalog.zones[zone];
  return "zone " + known.name + " cannot be loaded: " + catalog.folder + "/" + known.pack + ": " +
         what_was_found(error) + what_to_do(error);
}

}  // namespace zonepack
