// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "packer/record/damage.hpp"
#include "packer/record/map_outline.hpp"
#include "packer/record/record.hpp"

namespace zonepack::packer {

// A map as a SLAM system wrote it, read-only: what everything behind it sees of a source.
//
// Errors: DamagedSignature when one signature cannot be read while every other one can; any other
// std::runtime_error, with a complete message, when the source as a whole cannot.
// Threads: one per object; another thread gets its own by reopen().
class MapSource {
 public:
  virtual ~MapSource() = default;

  // The same source for another thread, sharing the outline.
  virtual std::unique_ptr<MapSource> reopen() const = 0;

  virtual const MapOutline& outline() const noexcept = 0;

  // Throws when the source changed since it was first opened.
  virtual void require_unchanged() const = 0;

  // Reads one signature of the outline with the wanted payloads. Replaces `into` and reuses its
  // memory.
  virtual void read(std::int32_t id, const PayloadSet& wanted, SignatureRecord& into) = 0;

  SignatureRecord read(std::int32_t id, const PayloadSet& wanted) {
    SignatureRecord record;
    read(id, wanted, record);
    return record;
  }

 protected:
  MapSource() = default;
  MapSource(MapSource&&) = default;
  MapSource& operator=(MapSource&&) = default;
};

}  // namespace zonepack::packer
