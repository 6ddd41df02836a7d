// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/rtabmap/rtabmap_links.hpp"

#include <algorithm>
#include <cstring>
#include <tuple>
#include <utility>

#include "packer/record/link_order.hpp"
#include "packer/sources/sqlite/cells.hpp"

namespace zonepack::packer {
namespace {

enum LinkColumn {
  kToId,
  kLinkType,
  kLinkTransform,
  kLinkUserData,
  kLinkInformation,
  kRotVariance,
  kTransVariance
};

constexpr std::size_t kMaxLinks = 1'000'000;
constexpr std::size_t kMaxGlobalDescriptors = 65536;  // of one signature

std::optional<Matrix> optional_matrix(const SqliteQuery& row, int column, const CellPlace& place,
                                      MatrixUnpacker& unpacker) {
  const auto blob = blob_cell(row, column, place);
  if (blob.empty()) return std::nullopt;
  Matrix matrix;
  unpacker.unpack(blob, place, matrix);
  return matrix;
}

}  // namespace

LinkReader::LinkReader(const SqliteFile& file, const RtabmapSchema& schema)
    : rows_(file,
            schema.columns("Link", {"to_id", "type", "transform", "user_data", "information_matrix",
                                    "rot_variance", "trans_variance"}),
            "Link", "from_id", kLargestValueBytes),
      has_variances_(schema.has("Link", "rot_variance") && schema.has("Link", "trans_variance")) {}

void LinkReader::read(const CellPlace& place, MatrixUnpacker& unpacker, std::vector<Link>& out) {
  out.clear();
  rows_.find(place.signature);
  const SqliteQuery& row = rows_.row();
  while (rows_.next()) {
    if (out.size() == kMaxLinks) {
      place.at("Link.from_id").damaged("expected at most 1000000 rows, found more");
    }
    Link link;
    link.to = int32_cell(row, kToId, place.at("Link.to_id"));
    link.type = int32_cell(row, kLinkType, place.at("Link.type"));
    link.transform = transform_cell(row, kLinkTransform, place.at("Link.transform"));
    read_information(place, link);
    link.user_data = optional_matrix(row, kLinkUserData, place.at("Link.user_data"), unpacker);
    out.push_back(std::move(link));
  }
  sort_links(out);
}

// RTAB-Map before 0.13 stored two variances; later versions read them as this diagonal.
void LinkReader::read_information(const CellPlace& place, Link& link) const {
  const SqliteQuery& row = rows_.row();
  const CellPlace matrix = place.at("Link.information_matrix");
  const auto bytes = blob_cell(row, kLinkInformation, matrix);
  expect_elements(bytes, 36, sizeof(double), "float64", matrix);
  if (!bytes.empty()) {
    link.information.resize(36);
    std::memcpy(link.information.data(), bytes.data(), bytes.size());
    return;
  }
  if (!has_variances_) return;
  const double rotation = finite_cell(row, kRotVariance, place.at("Link.rot_variance"));
  const double translation = finite_cell(row, kTransVariance, place.at("Link.trans_variance"));
  if (!(rotation > 0) || !(translation > 0)) {
    place.at("Link.rot_variance").damaged("expected variances greater than 0");
  }
  link.information.assign(36, 0.0);
  for (std::size_t i = 0; i < 6; ++i) {
    link.information[i * 7] = 1.0 / (i < 3 ? translation : rotation);
  }
}

GlobalDescriptorReader::GlobalDescriptorReader(const SqliteFile& file, const RtabmapSchema& schema)
    : rows_(file, schema.columns("GlobalDescriptor", {"type", "info", "data"}), "GlobalDescriptor",
            "node_id", kLargestValueBytes) {}

void GlobalDescriptorReader::read(const CellPlace& place, MatrixUnpacker& unpacker,
                                  std::vector<GlobalDescriptor>& out) {
  out.clear();
  rows_.find(place.signature);
  const SqliteQuery& row = rows_.row();
  while (rows_.next()) {
    if (out.size() == kMaxGlobalDescriptors) {
      place.at("GlobalDescriptor.node_id").damaged("expected at most 65536 rows, found more");
    }
    GlobalDescriptor descriptor;
    descriptor.type = int32_cell(row, 0, place.at("GlobalDescriptor.type"));
    descriptor.info = optional_matrix(row, 1, place.at("GlobalDescriptor.info"), unpacker);
    const CellPlace data = place.at("GlobalDescriptor.data");
    unpacker.unpack(blob_cell(row, 2, data), data, descriptor.data);
    out.push_back(std::move(descriptor));
  }
}

}  // namespace zonepack::packer
