// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include "runtime/client/client.hpp"
#include "runtime/client/zonepack_client.h"

// Either a connection or memory alone.
struct zp_client {
  std::optional<zonepack::Client> connected;
  std::optional<zonepack::SharedReader> alone;

  zonepack::SharedReader& reader() { return connected ? connected->reader() : *alone; }
};

struct zp_zone {
  zonepack::ZoneSignatures signatures;
};

namespace {

using zonepack::ErrorCode;

zp_status status_of(zonepack::ReadStatus status) { return static_cast<zp_status>(status); }
static_assert(static_cast<int>(zonepack::ReadStatus::kOk) == ZP_OK);
static_assert(static_cast<int>(zonepack::ReadStatus::kExpired) == ZP_EXPIRED);
static_assert(static_cast<int>(zonepack::ReadStatus::kAbsent) == ZP_ABSENT);
static_assert(static_cast<int>(zonepack::ReadStatus::kDamaged) == ZP_DAMAGED);

zp_status status_of(zonepack::Error error) {
  switch (error.code) {
    case ErrorCode::kOk:
      return ZP_OK;
    case ErrorCode::kNotFound:
      return ZP_ABSENT;
    case ErrorCode::kBusy:
      return ZP_BUSY;
    case ErrorCode::kCancelled:
      return ZP_NO_SERVER;
    case ErrorCode::kBadMagic:
    case ErrorCode::kBadStructure:
    case ErrorCode::kTruncated:
      return ZP_DAMAGED;
    default:
      return ZP_REFUSED;
  }
}

void set_status(zp_status* out, zp_status status) {
  if (out != nullptr) *out = status;
}

std::optional<zonepack::SignatureView> signature_at(const zp_zone* zone, std::uint32_t index) {
  if (index >= zone->signatures.size()) return std::nullopt;
  return zone->signatures[index];
}

const std::uint8_t* data_of(zonepack::ByteSpan bytes) {
  return bytes.empty() ? nullptr : reinterpret_cast<const std::uint8_t*>(bytes.data());
}

int copy(const std::optional<zonepack::RigidTransform>& transform, float (&out)[12]) {
  if (!transform) return 0;
  std::ranges::copy(*transform, out);
  return 1;
}

zonepack::TableRows rows_of(const zonepack::SignatureView& signature, zp_points_kind kind) {
  switch (kind) {
    case ZP_SCAN_POINTS:
      return signature.rows(zonepack::fb::Part::Scan);
    case ZP_GROUND:
      return signature.rows(zonepack::fb::Part::GroundCells);
    case ZP_OBSTACLES:
      return signature.rows(zonepack::fb::Part::ObstacleCells);
    case ZP_EMPTY:
      return signature.rows(zonepack::fb::Part::EmptyCells);
  }
  return {};
}

}  // namespace

zp_client* zp_connect(const char* socket_path, const char* program_name, int timeout_ms,
                      zp_status* status) {
  auto connected = zonepack::Client::connect(socket_path, program_name, timeout_ms);
  if (!connected) {
    const bool nobody = connected.error().code == ErrorCode::kNotFound;
    set_status(status, nobody ? ZP_NO_SERVER : status_of(connected.error()));
    return nullptr;
  }
  set_status(status, ZP_OK);
  return new zp_client{std::move(*connected), std::nullopt};
}

zp_client* zp_open_memory(const void* memory, size_t bytes, zp_status* status) {
  const auto reader = zonepack::SharedReader::open({static_cast<const std::byte*>(memory), bytes});
  set_status(status, status_of(reader.error()));
  return reader ? new zp_client{std::nullopt, *reader} : nullptr;
}

void zp_close(zp_client* client) { delete client; }

zp_status zp_find_zone(zp_client* client, const char* name, uint32_t* zone) {
  if (!client->connected) return ZP_NO_SERVER;
  const auto found = client->connected->find_zone(name);
  if (found) *zone = *found;
  return status_of(found.error());
}

uint32_t zp_zone_count(const zp_client* client) {
  return const_cast<zp_client*>(client)->reader().zone_count();
}

zp_status zp_take_lease(zp_client* client, uint32_t zone, zp_lease* lease) {
  if (!client->connected) return ZP_NO_SERVER;
  const auto granted = client->connected->lease(zone);
  if (granted) *lease = {granted->zone, granted->generation, granted->epoch, granted->lasts_ns};
  return status_of(granted.error());
}

zp_status zp_release(zp_client* client, const zp_lease* lease) {
  if (!client->connected) return ZP_NO_SERVER;
  return status_of(
      client->connected->release({lease->zone, lease->generation, lease->epoch, lease->lasts_ns})
          .error());
}

zp_status zp_give_pose(zp_client* client, double x, double y, double yaw,
                       const double covariance[6], int64_t stamp_ns) {
  if (!client->connected) return ZP_NO_SERVER;
  zonepack::PoseInMap pose{x, y, yaw, {}};
  std::copy_n(covariance, 6, pose.covariance.begin());
  return status_of(client->connected->give_pose(pose, stamp_ns).error());
}

zp_status zp_read(zp_client* client, uint32_t zone, void (*fn)(const zp_zone*, void*), void* user) {
  return status_of(client->reader().read(zone, [&](const zonepack::ZoneSignatures& signatures) {
    const zp_zone view{signatures};
    fn(&view, user);
  }));
}

uint32_t zp_signature_count(const zp_zone* zone) { return zone->signatures.size(); }

int zp_get_signature(const zp_zone* zone, uint32_t index, zp_signature* out) {
  *out = {};
  const auto signature = signature_at(zone, index);
  if (!signature) return 0;
  out->id = signature->id();
  out->map_id = signature->map_id();
  out->weight = signature->weight();
  out->stamp_s = signature->stamp_s();
  out->label = signature->label().data();
  out->label_bytes = signature->label().size();
  out->has_pose = copy(signature->T_map_base(), out->T_map_base);
  out->has_odometry_pose = copy(signature->T_odom_base(), out->T_odom_base);
  out->features = signature->features().size();
  signature->for_each_link([&](const zonepack::LinkView&) { ++out->links; });
  out->calibration = data_of(signature->calibration());
  out->calibration_bytes = signature->calibration().size();
  return 1;
}

uint32_t zp_features(const zp_zone* zone, uint32_t index, void (*fn)(const zp_feature*, void*),
                     void* user) {
  const auto signature = signature_at(zone, index);
  if (!signature) return 0;
  signature->features().for_each([&](const zonepack::Feature& f) {
    const zp_feature out{f.x_px,
                         f.y_px,
                         f.size_px,
                         f.angle,
                         f.response,
                         f.octave,
                         f.word_id,
                         {f.p_base[0], f.p_base[1], f.p_base[2]},
                         data_of(f.descriptor),
                         f.descriptor.size()};
    fn(&out, user);
  });
  return signature->features().size();
}

uint32_t zp_links(const zp_zone* zone, uint32_t index, void (*fn)(const zp_link*, void*),
                  void* user) {
  const auto signature = signature_at(zone, index);
  if (!signature) return 0;
  uint32_t count = 0;
  signature->for_each_link([&](const zonepack::LinkView& link) {
    zp_link out{link.to, link.type, 0, {}, nullptr};
    out.has_transform = copy(link.T_from_to, out.T_from_to);
    if (!link.information.empty()) out.information = link.information.data();
    ++count;
    fn(&out, user);
  });
  return count;
}

int zp_get_scan(const zp_zone* zone, uint32_t index, zp_scan* out) {
  *out = {};
  const auto signature = signature_at(zone, index);
  const auto scan = signature ? signature->scan() : std::nullopt;
  if (!scan) return 0;
  *out = {scan->format,       scan->range_min_m,     scan->range_max_m, scan->angle_min,
          scan->angle_max,    scan->angle_increment, scan->max_points,  {},
          scan->points.size()};
  std::ranges::copy(scan->T_base_scan, out->T_base_scan);
  return 1;
}

int zp_get_grid(const zp_zone* zone, uint32_t index, zp_grid* out) {
  *out = {};
  const auto signature = signature_at(zone, index);
  const auto grid = signature ? signature->grid() : std::nullopt;
  if (!grid) return 0;
  *out = {grid->cell_m, {}, grid->ground.size(), grid->obstacles.size(), grid->empty.size()};
  std::ranges::copy(grid->view_point, out->view_point);
  return 1;
}

uint32_t zp_points(const zp_zone* zone, uint32_t index, zp_points_kind kind,
                   void (*fn)(const float*, uint32_t, void*), void* user) {
  const auto signature = signature_at(zone, index);
  if (!signature) return 0;
  uint32_t count = 0;
  rows_of(*signature, kind).for_each_point([&](std::span<const float> numbers) {
    ++count;
    fn(numbers.data(), static_cast<std::uint32_t>(numbers.size()), user);
  });
  return count;
}

size_t zp_blob(const zp_zone* zone, uint32_t index, zp_blob_kind kind,
               void (*fn)(const uint8_t*, size_t, void*), void* user) {
  const auto signature = signature_at(zone, index);
  if (!signature) return 0;
  size_t sum = 0;
  const auto part = kind == ZP_IMAGE ? zonepack::fb::Part::Image : zonepack::fb::Part::Depth;
  signature->rows(part).for_each_piece([&](zonepack::ByteSpan piece) {
    sum += piece.size();
    fn(data_of(piece), piece.size(), user);
  });
  return sum;
}

namespace {

void describe(const zonepack::BlockView& block, zp_block* out) {
  *out = {block.position().x, block.position().y, block.position().z, 0};
  for (std::uint32_t layer = 0; layer < zonepack::kVoxelLayers; ++layer) {
    if (block.has(static_cast<zonepack::VoxelLayer>(layer))) out->layers |= 1U << layer;
  }
}

}  // namespace

double zp_block_size(const zp_zone* zone) { return zone->signatures.blocks().block_size_m(); }

uint32_t zp_block_count(const zp_zone* zone) { return zone->signatures.blocks().size(); }

int zp_get_block(const zp_zone* zone, uint32_t index, zp_block* out) {
  *out = {};
  const zonepack::BlocksView blocks = zone->signatures.blocks();
  if (index >= blocks.size()) return 0;
  describe(blocks[index], out);
  return 1;
}

int zp_find_block(const zp_zone* zone, int32_t x, int32_t y, int32_t z, zp_block* out) {
  *out = {};
  const auto block = zone->signatures.blocks().find(x, y, z);
  if (!block) return 0;
  describe(*block, out);
  return 1;
}

int zp_copy_block(const zp_zone* zone, int32_t x, int32_t y, int32_t z, zp_layer layer, void* out,
                  size_t bytes) {
  const auto block = zone->signatures.blocks().find(x, y, z);
  if (!block || layer > ZP_ESDF) return 0;
  return block->copy(static_cast<zonepack::VoxelLayer>(layer),
                     {static_cast<std::byte*>(out), bytes})
             ? 1
             : 0;
}
