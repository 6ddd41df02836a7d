# SPDX-License-Identifier: Apache-2.0
# Fixes of a mission's images; bench/localize.sh runs it.
if(TARGET zonepack_localize)
  zonepack_measurement(localize_queries.cpp zonepack_localizer)
  zonepack_measurement(localize_lost.cpp zonepack_localize)
endif()
