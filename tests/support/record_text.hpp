// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "packer/record/record.hpp"
#include "runtime/pack_format/file/manifest_file.hpp"

namespace zonepack::test_support {

// Everything that a signature holds as JSON: numbers exactly, "nan" for NaN, bytes in hexadecimal,
// null for what is absent.
nlohmann::ordered_json to_json(const packer::SignatureRecord& record);

// Everything that a manifest holds.
nlohmann::ordered_json to_json(const fb::Manifest& manifest);

}  // namespace zonepack::test_support
