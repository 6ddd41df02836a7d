// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/rtabmap/rtabmap_features.hpp"

#include <limits>
#include <span>
#include <string>

#include "packer/sources/sqlite/cells.hpp"

namespace zonepack::packer {
namespace {

enum FeatureColumn {
  kWordId,
  kPosX,
  kPosY,
  kSize,
  kDir,
  kResponse,
  kOctave,
  kDepthX,
  kDepthY,
  kDepthZ,
  kDescriptorSize,
  kDescriptor
};

constexpr std::size_t kMaxFeatures = 1'000'000;  // a thousand times what RTAB-Map stores
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

std::string describe(Features::DescriptorType type, std::size_t dim) {
  switch (type) {
    case Features::DescriptorType::kNone:
      return "none";
    case Features::DescriptorType::kU8:
      return std::to_string(dim) + " bytes";
    case Features::DescriptorType::kF32:
      return std::to_string(dim) + " float32";
  }
  return {};
}

void clear(Features& out) {
  out.count = 0;
  for (auto* column : {&out.x, &out.y, &out.size, &out.angle, &out.response, &out.point_x,
                       &out.point_y, &out.point_z}) {
    column->clear();
  }
  out.octave.clear();
  out.word_id.clear();
  out.descriptors.clear();
  out.descriptor_type = Features::DescriptorType::kNone;
  out.descriptor_dim = 0;
}

}  // namespace

FeatureReader::FeatureReader(const SqliteFile& file, const RtabmapSchema& schema)
    : rows_(file,
            schema.columns(schema.feature_table(),
                           {"word_id", "pos_x", "pos_y", "size", "dir", "response", "octave",
                            "depth_x", "depth_y", "depth_z", "descriptor_size", "descriptor"}),
            schema.feature_table(), "node_id"),
      has_octave_(schema.has(schema.feature_table(), "octave")) {}

void FeatureReader::read(const CellPlace& place, Features& out) {
  clear(out);
  rows_.find(place.signature);
  const SqliteQuery& row = rows_.row();
  while (rows_.next()) {
    if (out.count == kMaxFeatures) {
      place.at("Feature.node_id").damaged("expected at most 1000000 rows, found more");
    }
    out.word_id.push_back(int32_cell(row, kWordId, place.at("Feature.word_id")));
    out.x.push_back(float_cell(row, kPosX, place.at("Feature.pos_x")));
    out.y.push_back(float_cell(row, kPosY, place.at("Feature.pos_y")));
    out.size.push_back(float_cell(row, kSize, place.at("Feature.size")));
    out.angle.push_back(float_cell(row, kDir, place.at("Feature.dir")));
    out.response.push_back(float_cell(row, kResponse, place.at("Feature.response")));
    out.octave.push_back(has_octave_ ? int32_cell(row, kOctave, place.at("Feature.octave")) : 0);
    out.point_x.push_back(float_cell(row, kDepthX, place.at("Feature.depth_x"), kNan));
    out.point_y.push_back(float_cell(row, kDepthY, place.at("Feature.depth_y"), kNan));
    out.point_z.push_back(float_cell(row, kDepthZ, place.at("Feature.depth_z"), kNan));
    append_descriptor(place.at("Feature.descriptor"), out);
    ++out.count;
  }
}

void FeatureReader::append_descriptor(const CellPlace& place, Features& out) {
  using Type = Features::DescriptorType;
  const SqliteQuery& row = rows_.row();
  const int storage = row.type(kDescriptor);
  if (storage != SQLITE_NULL && storage != SQLITE_BLOB) place.damaged("expected a blob");
  const auto bytes = row.blob(kDescriptor);
  Type type = Type::kNone;
  std::uint32_t dim = 0;
  if (!bytes.empty()) {
    const auto declared = int32_cell(row, kDescriptorSize, place.at("Feature.descriptor_size"));
    dim = declared > 0 ? static_cast<std::uint32_t>(declared) : 0;
    if (bytes.size() == dim) {
      type = Type::kU8;
    } else if (bytes.size() == std::uint64_t{dim} * sizeof(float)) {
      type = Type::kF32;
    } else {
      place.damaged("expected " + std::to_string(declared) + " bytes or float32, found " +
                    std::to_string(bytes.size()) + " bytes");
    }
  }
  if (out.count == 0) {
    out.descriptor_type = type;
    out.descriptor_dim = dim;
  } else if (type != out.descriptor_type || dim != out.descriptor_dim) {
    place.damaged("expected one kind of descriptor in a signature, found " +
                  describe(out.descriptor_type, out.descriptor_dim) + " and " +
                  describe(type, dim));
  }
  out.descriptors.insert(out.descriptors.end(), bytes.begin(), bytes.end());
}

}  // namespace zonepack::packer
