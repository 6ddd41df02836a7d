// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "platform/base/result.hpp"
#include "platform/storage.hpp"
#include "runtime/map/catalog.hpp"

namespace zonepack {

// Whether a map can take the place of one in use: it is another version of the same map (kExists:
// the very same), and every pack is there, at full length, with the index that the manifest tells
// of. What stands in the packs is checked when it is loaded. On an error `fault` is a complete
// message that names the file.   Threads: any; reads a little of every pack, so not for the control
// thread.
Result<void> check_next_version(const Catalog& in_use, const Catalog& next, ReadMode mode,
                                std::string& fault);

}  // namespace zonepack
