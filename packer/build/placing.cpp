// SPDX-License-Identifier: Apache-2.0
#include "packer/build/placing.hpp"

#include <optional>
#include <set>

namespace zonepack::packer {

Placing place_signatures(const MapOutline& outline, UnlinkedPolicy policy) {
  std::set<std::int32_t> placed_sessions;
  for (const NodeOutline& node : outline.nodes) {
    if (node.pose) placed_sessions.insert(node.map_id);
  }
  const bool all = policy == UnlinkedPolicy::kOdometryAll || placed_sessions.empty();
  const bool by_odometry =
      policy == UnlinkedPolicy::kOdometry || policy == UnlinkedPolicy::kOdometryAll;
  Placing placing;
  for (const NodeOutline& node : outline.nodes) {
    if (node.damaged) continue;
    const bool connected = all || placed_sessions.contains(node.map_id);
    if (by_odometry && !connected) ++placing.unconnected_by_session[node.map_id];
    const bool odometry = by_odometry && connected;
    const std::optional<Transform>& base = node.pose || !odometry ? node.pose : node.odometry_pose;
    if (base) {
      placing.placed.push_back({&node, *base});
    } else {
      ++placing.dropped;
    }
  }
  return placing;
}

}  // namespace zonepack::packer
