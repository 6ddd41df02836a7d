// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "packer/record/source_kind.hpp"

namespace zonepack::packer {

extern const SourceKind kNvbloxKind;

}  // namespace zonepack::packer
