// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "platform/base/result.hpp"
#include "platform/memory/shared_memory.hpp"
#include "runtime/client/shared_reader.hpp"
#include "runtime/protocol/connection.hpp"

namespace zonepack {

struct ZoneInfo {
  ZoneId zone = kNoZone;
  std::string name;
  std::string type;
  std::uint32_t signatures = 0;
};

// Keeps a zone from being unloaded in favour of others until released or expired; the robot's own
// zone may still take its room. A read is checked all the same, lease or not.
struct ZoneLease {
  ZoneId zone = kNoZone;
  std::uint32_t generation = 0;
  std::uint32_t epoch = 0;
  std::int64_t lasts_ns = 0;  // from when it was granted
};

// A pose in the map: metres, radians; covariance of x, y, yaw, row by row: xx xy xyaw yy yyaw
// yawyaw.
struct PoseInMap {
  double x = 0, y = 0, yaw = 0;
  std::array<double, 6> covariance{};
};

struct RobotPose {
  PoseInMap pose;
  std::int64_t stamp_ns = 0;  // the run's clock
  bool trusted = false;       // two fixes agreed
  ZoneId zone = kNoZone;
};

struct NearSignature {
  SignatureId id = 0;
  ZoneId zone = kNoZone;
  float x = 0, y = 0, z = 0, yaw = 0;
  float distance_m = 0;
};

// A program's connection to zoned: the map's memory, read in place, and requests over the socket.
// config/SETTINGS.md says where the socket is and who may use it.
//
// Errors: kNotFound (no zoned there, no such zone, zone not loaded), kBusy (no answer in time; try
// again), kCancelled (zoned is gone: make a new Client), kBadVersion (of another version), kNoRoom,
// kTooLarge (too many clients or leases), kMismatch (the map changed: look the zone up again), kIo
// with errno; last_words() is what zoned said about it.
//
// While a Client exists its memory stays mapped, even if zoned dies, and counts against zoned's
// limit: destroy a Client whose calls return kCancelled.
//
// Ownership: owns the connection and the mapping; what read() passes to fn is valid only inside fn.
// Threads: one at a time.
// Real-time: read() never waits; all other calls wait for zoned, at most the timeout.
class Client {
 public:
  static Result<Client> connect(const std::string& socket, const std::string& name,
                                int timeout_ms = 2000);

  // The zones of the map, by number. Fetched again when the map changed.
  Result<std::span<const ZoneInfo>> zones();
  // kNotFound for a name that the map does not have.
  Result<ZoneId> find_zone(std::string_view name);

  // Calls fn(const ZoneSignatures&) with the zone's signatures, in place. What fn read is valid
  // only if this returns kOk; see SharedReader. kAbsent also for a number that was looked up before
  // the map changed: zones() and find_zone() give the new one.
  template <typename Fn>
  ReadStatus read(ZoneId zone, Fn&& fn) {
    if (zones_epoch_ != 0 && reader_.epoch() != zones_epoch_) return ReadStatus::kAbsent;
    bool same = true;
    const ReadStatus status = reader_.read(zone, [&](const ZoneSignatures& signatures) {
      same = zones_epoch_ == 0 || reader_.epoch() == zones_epoch_;
      if (same) fn(signatures);
    });
    return same ? status : ReadStatus::kAbsent;
  }
  SharedReader& reader() noexcept { return reader_; }

  Result<ZoneLease> lease(ZoneId zone);
  Result<void> release(const ZoneLease& lease);

  Result<RobotPose> pose();
  // What a localizer found: where the robot was at stamp_ns of CLOCK_MONOTONIC.
  Result<void> give_pose(const PoseInMap& pose, std::int64_t stamp_ns);
  // Nearest first; within radius_m of (x, y).
  Result<std::vector<NearSignature>> nearest(double x, double y, double radius_m,
                                             std::uint32_t most);

  std::string_view last_words() const noexcept { return last_words_; }
  // For everything else in the protocol (PROTOCOL.md).
  Connection& connection() noexcept { return *connection_; }

 private:
  Client(std::unique_ptr<Connection> connection, SharedMemory memory, SharedReader reader);

  template <typename Body>
  Result<const wire::Reply*> ask(MessageBuilder& message, flatbuffers::Offset<Body> body,
                                 bool about_zones = false);

  std::unique_ptr<Connection> connection_;  // holds the lock that marks this reader
  SharedMemory memory_;
  SharedReader reader_;
  std::uint32_t map_serial_;
  std::uint32_t zones_serial_ = 0;  // of zones_; 0: not fetched yet
  std::uint32_t zones_epoch_ = 0;   // of the map that zone numbers belong to; 0: zoned does not say
  std::vector<ZoneInfo> zones_;
  std::string last_words_;
};

}  // namespace zonepack
