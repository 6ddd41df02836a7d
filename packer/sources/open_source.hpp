// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include "packer/record/source_kind.hpp"

namespace zonepack::packer {

// Every kind of map that can be packed, one folder of packer/sources each, in the order in which a
// file is tried.
std::span<const SourceKind* const> source_kinds() noexcept;

// What a source is: options.kind, or what its content shows; nullptr: none of these. Throws
// std::runtime_error when there is no kind of that name.
const SourceKind* recognised_kind(const SourceOptions& options);

// Opens a source as what its content shows it to be, or as options.kind. Throws std::runtime_error
// with what the file is and what to do when it is none that can be packed, SourceUsageError when
// options place a map that has its frame already.
std::unique_ptr<MapSource> open_source(const SourceOptions& options);

}  // namespace zonepack::packer
