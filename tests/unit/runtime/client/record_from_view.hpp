// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "packer/record/record.hpp"
#include "runtime/client/signature_view.hpp"

namespace zonepack::test_support {

// A signature as a client sees it, in the form in which the packer read it from the database.
packer::SignatureRecord record_from(const SignatureView& signature);

}  // namespace zonepack::test_support
