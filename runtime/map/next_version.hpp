// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "platform/base/failure.hpp"
#include "platform/files/storage.hpp"
#include "runtime/map/catalog.hpp"

namespace zonepack {

// Whether a map can replace the one in use: it is another version of the same map (kMismatch: of
// another map; kExists: the same version), and every pack is present at full length, with the index
// that the manifest expects. The chunks of a pack are checked when they are loaded.
//
// Threads: any but the control thread; reads a little of every pack.
Outcome<void> check_next_version(const Catalog& in_use, const Catalog& next, ReadMode mode);

// Whether the packs confirm what the manifest claims of them, as far as memory is reserved for it:
// before the start of a run. A pack that its manifest describes wrongly is refused by name. A pack
// that is missing or damaged costs only its zone; but `without_budget`, where claims alone decide
// how much is reserved, its claim must not be more than twice that of any pack that was read.
//
// Threads: any but the control thread; reads the index of every pack.
Outcome<void> check_claims(const Catalog& map, bool without_budget, ReadMode mode);

}  // namespace zonepack
