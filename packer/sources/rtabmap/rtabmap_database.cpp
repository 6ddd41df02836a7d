// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/rtabmap/rtabmap_database.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "packer/sources/rtabmap/rtabmap_data.hpp"
#include "packer/sources/rtabmap/rtabmap_features.hpp"
#include "packer/sources/rtabmap/rtabmap_links.hpp"
#include "packer/sources/rtabmap/rtabmap_outline.hpp"
#include "packer/sources/rtabmap/rtabmap_schema.hpp"
#include "packer/sources/rtabmap/zlib_blob.hpp"
#include "packer/sources/sqlite/cells.hpp"

namespace zonepack::packer {

// The statements of one connection, prepared once.
class RtabmapDatabase::Reader {
 public:
  explicit Reader(const std::filesystem::path& path)
      : file_(path), schema_(file_), nodes_(file_, node_columns(schema_), "Node", "id") {
    if (schema_.has("Link", "from_id")) links_.emplace(file_, schema_);
    if (schema_.has("GlobalDescriptor", "node_id")) global_descriptors_.emplace(file_, schema_);
    if (schema_.has(schema_.feature_table(), "node_id")) features_.emplace(file_, schema_);
  }

  const SqliteFile& file() const { return file_; }
  const RtabmapSchema& schema() const { return schema_; }

  void read(std::int32_t id, const PayloadSet& wanted, SignatureRecord& into) {
    const CellPlace place{&file_.name(), id, ""};
    read_node_row(place, into);
    into.links.clear();
    if (links_) links_->read(place, unpacker_, into.links);
    if (schema_.has("Data", "id")) {
      if (!data_ || !data_->serves(wanted)) data_.emplace(file_, schema_, wanted);
      data_->read(place, unpacker_, into);
    }
    if (!wanted.features) {
      into.features = Features();
      into.global_descriptors.clear();
      return;
    }
    if (features_) features_->read(place, into.features);
    into.global_descriptors.clear();
    if (global_descriptors_) global_descriptors_->read(place, unpacker_, into.global_descriptors);
  }

 private:
  void read_node_row(const CellPlace& place, SignatureRecord& into) {
    nodes_.find(place.signature);
    if (!nodes_.next()) place.at("Node.id").damaged("expected a row, found none");
    const SqliteQuery& row = nodes_.row();
    NodeOutline node;
    read_node(row, place, node);
    into.id = place.signature;
    into.map_id = node.map_id;
    into.weight = node.weight;
    into.stamp = node.stamp;
    into.label = std::move(node.label);
    into.odometry_pose = node.odometry_pose;
    int column = kFirstNodeDetail;
    into.ground_truth_pose = transform_cell(row, column++, place.at("Node.ground_truth_pose"));
    const auto take = [&](const char* name, std::size_t count, std::size_t element, Bytes& to) {
      const auto bytes = blob_cell(row, column++, place.at(name));
      const bool open_ended = count == 0;
      const std::size_t expected = open_ended ? (bytes.size() / element / 3 + 1) * 3 : count;
      const bool whole_triples = open_ended && bytes.size() % (3 * element) == 0;
      if (!whole_triples) {
        expect_elements(bytes, expected, element, element == 4 ? "float32" : "float64",
                        place.at(name));
      }
      assign(to, bytes);
    };
    take("Node.velocity", 6, sizeof(float), into.velocity);
    take("Node.gps", 6, sizeof(double), into.gps);
    take("Node.env_sensors", 0, sizeof(double), into.env_sensors);
    if (nodes_.next()) place.at("Node.id").damaged("expected one row, found two");
  }

  SqliteFile file_;
  RtabmapSchema schema_;
  MatrixUnpacker unpacker_;
  KeyedRows nodes_;
  std::optional<LinkReader> links_;
  std::optional<GlobalDescriptorReader> global_descriptors_;
  std::optional<FeatureReader> features_;
  std::optional<DataReader> data_;
};

RtabmapDatabase::RtabmapDatabase(const std::filesystem::path& path)
    : path_(path), reader_(std::make_unique<Reader>(path)) {
  outline_ = std::make_shared<const MapOutline>(read_outline(reader_->file(), reader_->schema()));
  reader_->file().require_unchanged();
}

void RtabmapDatabase::require_unchanged() const { reader_->file().require_unchanged(); }

RtabmapDatabase::RtabmapDatabase(const std::filesystem::path& path,
                                 std::shared_ptr<const MapOutline> outline)
    : path_(path), outline_(std::move(outline)), reader_(std::make_unique<Reader>(path)) {}

RtabmapDatabase::~RtabmapDatabase() = default;
RtabmapDatabase::RtabmapDatabase(RtabmapDatabase&&) noexcept = default;
RtabmapDatabase& RtabmapDatabase::operator=(RtabmapDatabase&&) noexcept = default;

std::unique_ptr<MapSource> RtabmapDatabase::reopen() const {
  std::unique_ptr<MapSource> again(new RtabmapDatabase(path_, outline_));
  require_unchanged();
  return again;
}

const MapOutline& RtabmapDatabase::outline() const noexcept { return *outline_; }

void RtabmapDatabase::read(std::int32_t id, const PayloadSet& wanted, SignatureRecord& into) {
  const NodeOutline* const node = outline_->find(id);
  if (node == nullptr) {
    throw SqliteError(path_.string() + ": has no signature " + std::to_string(id));
  }
  if (node->damaged) {
    const auto damage = std::find_if(outline_->damages.begin(), outline_->damages.end(),
                                     [id](const Damage& d) { return d.signature == id; });
    throw DamagedSignature(path_.string(), *damage);
  }
  try {
    reader_->read(id, wanted, into);
  } catch (const SqliteCorrupt& error) {
    throw DamagedSignature(path_.string(), {id, "database file", error.problem()});
  } catch (const DamagedSignature&) {
    require_unchanged();
    throw;
  }
  into.pose = node->pose;
}

}  // namespace zonepack::packer
