// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include "packer/record/map_source.hpp"

namespace zonepack::packer {

// Calls work(source, i) once for each i below `count`, in order, on `jobs` threads (0: one per
// core), each with the source opened for itself; null where `source` is. Returns how many threads
// there were. The first exception ends the work and is thrown when all threads are done.
std::size_t run_zone_jobs(std::size_t count, unsigned jobs, const MapSource* source,
                          const std::function<void(MapSource*, std::size_t)>& work);

}  // namespace zonepack::packer
