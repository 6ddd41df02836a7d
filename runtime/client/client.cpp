// SPDX-License-Identifier: Apache-2.0
#include "runtime/client/client.hpp"

#include <algorithm>
#include <cerrno>

namespace zonepack {
namespace {

Error error_of(wire::Fault fault) {
  switch (fault) {
    case wire::Fault::NotFound:
    case wire::Fault::Unavailable:
      return {ErrorCode::kNotFound, 0};
    case wire::Fault::Busy:
      return {ErrorCode::kBusy, 0};
    case wire::Fault::NoRoom:
      return {ErrorCode::kNoRoom, 0};
    case wire::Fault::StaleMap:
      return {ErrorCode::kMismatch, 0};
    case wire::Fault::TooMany:
      return {ErrorCode::kTooLarge, 0};
    case wire::Fault::Denied:
      return {ErrorCode::kIo, EACCES};
    case wire::Fault::Version:
      return {ErrorCode::kBadVersion, 0};
    default:
      return {ErrorCode::kBadValue, static_cast<std::int64_t>(fault)};
  }
}

Result<Descriptor> own_descriptor(const Connection& connection, wire::FdKind kind) {
  Descriptor theirs(connection.descriptor(kind));
  if (!theirs.is_open()) return ErrorCode::kNotFound;
  Result<Descriptor> own = theirs.share();
  theirs.release();
  return own;
}

}  // namespace

Client::Client(std::unique_ptr<Connection> connection, SharedMemory memory, SharedReader reader)
    : connection_(std::move(connection)),
      memory_(std::move(memory)),
      reader_(std::move(reader)),
      map_serial_(connection_->welcome().map_serial()),
      zones_epoch_(connection_->welcome().map_epoch()) {}

Result<Client> Client::connect(const std::string& socket, const std::string& name, int timeout_ms) {
  Result<Connection> opened = Connection::open(socket, name, timeout_ms);
  if (!opened) return opened.error();
  auto connection = std::make_unique<Connection>(std::move(*opened));
  Result<Descriptor> file = own_descriptor(*connection, wire::FdKind::Memory);
  if (!file) return file.error();
  Result<SharedMemory> memory = SharedMemory::map_read_only(std::move(*file));
  if (!memory) return memory.error();
  const Result<SharedReader> reader = SharedReader::open(memory->read_only());
  if (!reader) return reader.error();
  return Client(std::move(connection), std::move(*memory), *reader);
}

template <typename Body>
Result<const wire::Reply*> Client::ask(MessageBuilder& message, flatbuffers::Offset<Body> body,
                                       bool about_zones) {
  last_words_.clear();
  connection_->on_notice([this](const wire::Reply& notice) {
    if (const auto* changed = notice.body_as_MapChanged()) map_serial_ = changed->map_serial();
  });
  const auto reply = connection_->ask(message, body, {}, about_zones ? zones_serial_ : 0);
  connection_->on_notice(nullptr);
  if (!reply) return reply.error();
  if ((*reply)->fault() == wire::Fault::None) return *reply;
  last_words_ = view_of((*reply)->text());
  return error_of((*reply)->fault());
}

Result<std::span<const ZoneInfo>> Client::zones() {
  const bool same = zones_epoch_ == 0 || reader_.epoch() == zones_epoch_;
  if (same && zones_serial_ == map_serial_) return std::span<const ZoneInfo>(zones_);
  const std::uint32_t serial = map_serial_;
  zones_serial_ = 0;
  zones_.clear();
  for (std::uint32_t first = 0, total = 1; first < total;) {
    MessageBuilder message;
    const auto reply = ask(message, wire::CreateAskZones(message.builder(), first));
    if (!reply) return reply.error();
    const wire::Zones* const part = (*reply)->body_as_Zones();
    if (part == nullptr || part->zones() == nullptr || part->first() != first ||
        (part->zones()->size() == 0 && first < part->total())) {
      return ErrorCode::kBadStructure;
    }
    for (const wire::Zone* const zone : *part->zones()) {
      zones_.push_back({zone->zone(), std::string(view_of(zone->name())),
                        std::string(view_of(zone->type())), zone->signatures()});
    }
    if (first != 0 && part->map_epoch() != zones_epoch_) return ErrorCode::kMismatch;
    zones_epoch_ = part->map_epoch();
    total = part->total();
    first += part->zones()->size();
  }
  if (serial != map_serial_) return ErrorCode::kMismatch;
  zones_serial_ = serial;
  return std::span<const ZoneInfo>(zones_);
}

Result<ZoneId> Client::find_zone(std::string_view name) {
  const auto all = zones();
  if (!all) return all.error();
  const auto found = std::ranges::find(*all, name, &ZoneInfo::name);
  if (found == all->end()) return ErrorCode::kNotFound;
  return found->zone;
}

Result<ZoneLease> Client::lease(ZoneId zone) {
  MessageBuilder message;
  const auto reply = ask(message, wire::CreateTakeLease(message.builder(), zone), true);
  if (!reply) return reply.error();
  const wire::Granted* const granted = (*reply)->body_as_Granted();
  if (granted == nullptr) return ErrorCode::kBadStructure;
  const wire::Lease& lease = *granted->lease();
  return ZoneLease{lease.zone(), lease.generation(), lease.epoch(), granted->lasts_ns()};
}

Result<void> Client::release(const ZoneLease& lease) {
  MessageBuilder message;
  const wire::Lease wired(lease.zone, lease.generation, lease.epoch);
  const auto reply = ask(message, wire::CreateRelease(message.builder(), &wired), true);
  return reply ? Result<void>() : reply.error();
}

Result<RobotPose> Client::pose() {
  MessageBuilder message;
  const auto reply = ask(message, wire::CreateAskPose(message.builder()));
  if (!reply) return reply.error();
  const wire::PoseReport* const report = (*reply)->body_as_PoseReport();
  if (report == nullptr) return ErrorCode::kBadStructure;
  if (!report->valid() || report->pose() == nullptr) return ErrorCode::kNotFound;
  RobotPose out;
  out.pose.x = report->pose()->x();
  out.pose.y = report->pose()->y();
  out.pose.yaw = report->pose()->yaw();
  if (const wire::Covariance* const c = report->covariance()) {
    out.pose.covariance = {c->xx(), c->xy(), c->x_yaw(), c->yy(), c->y_yaw(), c->yaw_yaw()};
  }
  out.stamp_ns = report->stamp_ns();
  out.trusted = report->trusted();
  out.zone = report->zone();
  return out;
}

Result<void> Client::give_pose(const PoseInMap& pose, std::int64_t stamp_ns) {
  MessageBuilder message;
  const auto& c = pose.covariance;
  const wire::Pose where(pose.x, pose.y, pose.yaw);
  const wire::Covariance covariance(c[0], c[1], c[2], c[3], c[4], c[5]);
  const auto reply = ask(message, wire::CreateGivePose(message.builder(), wire::Clock::Monotonic,
                                                       stamp_ns, &where, &covariance));
  return reply ? Result<void>() : reply.error();
}

Result<std::vector<NearSignature>> Client::nearest(double x, double y, double radius_m,
                                                   std::uint32_t most) {
  MessageBuilder message;
  const auto reply =
      ask(message, wire::CreateAskNearest(message.builder(), x, y, radius_m, most, false));
  if (!reply) return reply.error();
  const wire::Nearest* const nearest = (*reply)->body_as_Nearest();
  if (nearest == nullptr) return ErrorCode::kBadStructure;
  std::vector<NearSignature> out;
  if (nearest->signatures() == nullptr) return out;
  for (const wire::Signature* const s : *nearest->signatures()) {
    out.push_back({s->id(), s->zone(), s->x(), s->y(), s->z(), s->yaw(), s->distance()});
  }
  return out;
}

}  // namespace zonepack
