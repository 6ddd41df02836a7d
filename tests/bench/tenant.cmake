# SPDX-License-Identifier: Apache-2.0
# The heavy neighbour of the map, and the fixes that were given beside it; bench/tenant.sh runs them.
zonepack_measurement(tenant.cpp Threads::Threads)
zonepack_measurement(recorded_fixes.cpp zonepack_runtime)
