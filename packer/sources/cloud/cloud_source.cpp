// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/cloud/cloud_source.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace zonepack::packer {
namespace {

constexpr std::int32_t kFloat32Depth = 5;  // OpenCV's depth

std::int32_t format_of(const CloudFields& f) {
  const std::int32_t mask = (f.intensity ? 1 : 0) + (f.rgb ? 2 : 0) + (f.ring ? 4 : 0);
  constexpr std::array<std::int32_t, 3> kKnown = {5, 6, 7};
  return mask < 3 ? kKnown[static_cast<std::size_t>(mask)] : CloudSource::kCloudFormat + mask;
}

}  // namespace

CloudSource::CloudSource(const char* kind, std::shared_ptr<const CloudMap> cloud, std::string name)
    : name_(std::move(name)), cloud_(std::move(cloud)) {
  auto outline = std::make_shared<MapOutline>();
  outline->kind = kind;
  outline->numbered_anew = true;
  outline->schema_version = cloud_->version;
  outline->warnings = cloud_->warnings;
  outline->notes = cloud_->notes;
  if (!cloud_->fields.dropped.empty()) {
    std::string names;
    for (const std::string& field : cloud_->fields.dropped)
      names += (names.empty() ? "" : ", ") + field;
    outline->notes.push_back("fields that are not carried: " + names);
  }
  outline->has_optimised_poses = true;
  outline->scan_bytes = cloud_->source_bytes;
  for (const CloudTile& tile : cloud_->tiles) {
    NodeOutline& node = outline->nodes.emplace_back();
    node.id = tile.id;
    node.label = tile.label;
    node.stamp = tile.stamp_s;
    node.pose = tile.T_map_base;
  }
  outline_ = std::move(outline);
}

CloudSource::CloudSource(std::string name, std::shared_ptr<const CloudMap> cloud,
                         std::shared_ptr<const MapOutline> outline)
    : name_(std::move(name)), cloud_(std::move(cloud)), outline_(std::move(outline)) {}

std::unique_ptr<MapSource> CloudSource::reopen() const {
  return std::unique_ptr<MapSource>(new CloudSource(name_, cloud_, outline_));
}

void CloudSource::read(std::int32_t id, const PayloadSet& wanted, SignatureRecord& into) {
  if (id < 1 || static_cast<std::size_t>(id) > cloud_->tiles.size()) {
    throw std::runtime_error(name_ + ": has no tile " + std::to_string(id));
  }
  const CloudTile& tile = cloud_->tiles[static_cast<std::size_t>(id - 1)];
  into = SignatureRecord();
  into.id = tile.id;
  into.label = tile.label;
  into.stamp = tile.stamp_s;
  into.pose = tile.T_map_base;
  if (wanted.scan) into.scan = scan_of(tile);
}

Scan CloudSource::scan_of(const CloudTile& tile) {
  const CloudFields& f = cloud_->fields;
  const std::size_t channels = f.words();
  if (tile.points > kLargestMatrixBytes / (channels * 4)) {
    throw DamagedSignature(name_,
                           {tile.id, "points",
                            "a tile of " + std::to_string(tile.points) +
                                " points is larger than 256 MiB; give a smaller --tile METRES"});
  }
  cloud_->read(tile, points_);
  sort_in_blocks(points_);
  Scan scan;
  scan.format = format_of(f);
  scan.local_transform = tile.T_base_points;
  scan.data.rows = 1;
  scan.data.cols = static_cast<std::int32_t>(points_.size());
  scan.data.type = kFloat32Depth + static_cast<std::int32_t>((channels - 1) << 3);
  scan.data.data.resize(points_.size() * channels * 4);
  std::byte* at = scan.data.data.data();
  const auto put = [&at](auto value) {
    std::memcpy(at, &value, 4);
    at += 4;
  };
  for (std::size_t i = 0; i < points_.size(); ++i) {
    put(points_.x[i]);
    put(points_.y[i]);
    put(points_.z[i]);
    if (f.intensity) put(points_.intensity[i]);
    if (f.rgb) put(points_.rgb[i]);
    if (f.ring) put(points_.ring[i]);
  }
  return scan;
}

}  // namespace zonepack::packer
