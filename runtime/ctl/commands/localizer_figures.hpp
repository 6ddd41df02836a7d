// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "runtime/protocol/protocol_generated.h"

// How zonectl shows the localizers that are connected to zoned.
namespace zonepack {

// "localizer v4l2:/dev/video0: 95.2 % of 1043 images with a fix; …", one a localizer.
std::vector<std::string> localizer_lines(const wire::Status& status);

// A list of objects: camera, images, fixes, share, skipped, refused, latency_ms, query_ms, reasons.
std::string localizers_json(const wire::Status& status);

// Prometheus text; empty without localizers.
std::string localizer_metrics(const wire::Status& status);

}  // namespace zonepack
