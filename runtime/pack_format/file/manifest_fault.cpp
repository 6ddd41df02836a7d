// SPDX-License-Identifier: Apache-2.0
#include "runtime/pack_format/file/manifest_fault.hpp"

#include "runtime/pack_format/file/manifest_file.hpp"

namespace zonepack {
namespace {

std::string place_text(const ManifestFault& fault) {
  const char* part = nullptr;
  switch (fault.part) {
    case ManifestFault::Part::kWhole:
      return {};
    case ManifestFault::Part::kZone:
      part = "zone";
      break;
    case ManifestFault::Part::kPortal:
      part = "portal";
      break;
    case ManifestFault::Part::kEdge:
      part = "edge";
      break;
  }
  const std::string entry = std::to_string(fault.entry);
  if (fault.name.empty()) return std::string(part) + " entry " + entry + ": ";
  return std::string(part) + " '" + std::string(fault.name) + "' (entry " + entry + "): ";
}

}  // namespace

std::string manifest_fault_text(const Error& error, const ManifestFault& fault) {
  const std::string detail = std::to_string(error.detail);
  if (fault.excess) return place_text(fault) + to_string(*fault.excess);
  switch (error.code) {
    case ErrorCode::kTruncated:
      return "the file has " + detail +
             " bytes, not as many as its header says: it was cut off or joined with another";
    case ErrorCode::kBadMagic:
      return "the file does not begin and end as a manifest does";
    case ErrorCode::kBadVersion:
      return "format version " + detail + ", this program reads " + std::to_string(kManifestMajor);
    case ErrorCode::kBadChecksum:
      return "bad checksum: the bytes do not have the BLAKE2b-256 at its end";
    case ErrorCode::kMismatch:
      return "slots of " + detail + " bytes, this format has " + std::to_string(kSlotBytes);
    default:
      break;
  }
  const std::string field = fault.field;
  return place_text(fault) + (field.empty() ? "" : field + " ") +
         (*fault.expected == '\0' ? to_string(error.code) : fault.expected);
}

}  // namespace zonepack
