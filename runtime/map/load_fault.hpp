// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "platform/base/result.hpp"
#include "runtime/map/catalog.hpp"

namespace zonepack {

// Why a zone could not be loaded, for a person: zone, file, what was found, what to do next. For
// errors of ZoneLoad. Allocates.
std::string load_fault(const Catalog& catalog, ZoneId zone, Error error);

}  // namespace zonepack
