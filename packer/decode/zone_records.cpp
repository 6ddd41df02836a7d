// SPDX-License-Identifier: Apache-2.0
#include "packer/decode/zone_records.hpp"

#include <stdexcept>
#include <vector>

#include "packer/decode/record_decoder.hpp"

namespace zonepack::packer {
namespace {

// Runs of signatures whose chunks are about `window_bytes` long.
std::vector<OrdinalRange> windows_of(const fb::PackIndex& index, ByteCount window_bytes) {
  std::vector<std::uint64_t> bytes(index.signatures());
  for (const fb::ChunkEntry* entry : *index.chunks()) {
    bytes[entry->first_signature()] += entry->decoded_size();
  }
  std::vector<OrdinalRange> windows;
  std::uint64_t sum = 0;
  for (std::uint32_t i = 0; i < index.signatures(); ++i) {
    if (windows.empty() || sum + bytes[i] > window_bytes) {
      windows.push_back({i, i});
      sum = 0;
    }
    windows.back().last = i;
    sum += bytes[i];
  }
  return windows;
}

}  // namespace

ZoneRecords::ZoneRecords(const MapReader& map, const fb::Zone& zone, PayloadMask wanted,
                         ByteCount window_bytes)
    : path_(map.pack_path(zone)),
      pack_(map.open_pack(zone)),
      wanted_(wanted),
      windows_(windows_of(pack_.index(), window_bytes)) {}

bool ZoneRecords::decode_next_window() {
  if (next_window_ == windows_.size()) return false;
  const OrdinalRange window = windows_[next_window_++];
  decoded_.reset();
  Result<DecodedPack> decoded = DecodedPack::decode(pack_, wanted_, window);
  if (!decoded) MapReader::fail(path_, decoded.error());
  decoded_.emplace(std::move(*decoded));
  if (decoded_->view().size() != window.last - window.first + 1) {
    MapReader::fail(path_, {ErrorCode::kMismatch, window.first});
  }
  next_ = window.first;
  return true;
}

bool ZoneRecords::next(SignatureRecord& into, std::uint32_t* ordinal) {
  const bool inside = next_window_ > 0 && next_ <= windows_[next_window_ - 1].last;
  if (!inside && !decode_next_window()) return false;
  if (ordinal != nullptr) *ordinal = next_;
  try {
    into = decode_record(decoded_->view(), next_++);
    if (into.blocks && into.blocks->layers_info.empty()) into.blocks->layers_info = layers_info_;
    if (into.blocks) layers_info_ = into.blocks->layers_info;
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path_ + ": " + error.what() + "; build the map again");
  }
  return true;
}

}  // namespace zonepack::packer
