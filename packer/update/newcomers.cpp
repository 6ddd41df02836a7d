// SPDX-License-Identifier: Apache-2.0
#include "packer/update/newcomers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <stdexcept>

#include "packer/align/trajectory.hpp"
#include "packer/zones/findings.hpp"
#include "packer/zones/partition.hpp"

namespace zonepack::packer {
namespace {

constexpr const char* kRtabmap = "rtabmap";
constexpr double kScaleOff = 0.02;  // a metric map fits with a scale nearer to 1

std::string seconds_text(double stamp) {
  char text[64];
  std::snprintf(text, sizeof text, "%.3f", stamp);
  return text;
}

void refuse_unlinked(const MapOutline& outline, const std::string& database) {
  if (outline.unlinked() == 0) return;
  throw std::runtime_error(
      database + ": " + std::to_string(outline.unlinked()) +
      (outline.unlinked() == 1 ? " signature has" : " signatures have") +
      " no optimised pose; open the database with RTAB-Map and close it cleanly, or update with "
      "--unlinked odometry or drop");
}

}  // namespace

bool aligns(const std::string& kind) { return kind == kRtabmap; }

Newcomers::Newcomers(const MapSource& database, const HeldSignatures& held, const ZonePlan& plan,
                     const UpdateOptions& options, const std::vector<NamedLayer>& layers,
                     UnlinkedPolicy unlinked)
    : numbers_(held, database.outline()) {
  const MapOutline& outline = database.outline();
  const std::string name = options.source.name();
  require_signatures(outline, name);
  if (unlinked == UnlinkedPolicy::kError) refuse_unlinked(outline, name);
  // Maps of keyframes come placed.
  if (!options.source.placement.trajectory.empty() && aligns(outline.kind)) {
    align_with(options.source.placement.trajectory, outline, name);
    // Odometry has a frame of its own, which the trajectory says nothing about.
    unlinked = UnlinkedPolicy::kDrop;
  }
  const Placing placing = place_signatures(outline, unlinked);
  dropped_ = placing.dropped;
  for (const auto& [session, count] : placing.unconnected_by_session) {
    warnings_.push_back(name + ": session " + std::to_string(session) + " with its " +
                        std::to_string(count) + (count == 1 ? " signature" : " signatures") +
                        " is connected to no other, so nothing says where it is; it is left out. "
                        "Keep it with --unlinked odometry-all");
  }
  for (const auto& [node, T] : placing.placed) {
    Newcomer newcomer;
    newcomer.node = node;
    newcomer.id = numbers_.id(node->id);
    newcomer.session = numbers_.session(node->map_id);
    newcomer.T_map_base = alignment_ ? alignment_->T_to_from(T) : T;
    newcomer.held = numbers_.shares(*node);
    if (!options.sessions.takes(layers, newcomer.session)) {
      ++not_chosen_;
      continue;
    }
    all_.push_back(newcomer);
  }
  std::ranges::sort(all_, {}, &Newcomer::id);
  place_in(plan);
}

void Newcomers::align_with(const std::filesystem::path& path, const MapOutline& outline,
                           const std::string& database) {
  const Trajectory trajectory = Trajectory::read(path);
  std::vector<Point3> from, to;
  double first = INFINITY, last = -INFINITY;
  for (const NodeOutline& node : outline.nodes) {
    if (!node.pose) continue;
    first = std::min(first, node.stamp);
    last = std::max(last, node.stamp);
    const auto there = trajectory.at(node.stamp);
    if (!there) continue;
    const Transform& T = *node.pose;
    from.push_back({T[3], T[7], T[11]});
    to.push_back({there->translation().x(), there->translation().y(), there->translation().z()});
  }
  try {
    // RTAB-Map's maps are metric, and points of a signature are stored relative to its base.
    alignment_ = fit_points(from, to, FitModel::kRigid);
  } catch (const std::runtime_error& error) {
    const auto& poses = trajectory.poses();
    throw std::runtime_error(
        path.string() + ": the alignment " + error.what() + ". " + std::to_string(from.size()) +
        (from.size() == 1 ? " signature" : " signatures") +
        " with an optimised pose lie between two of its stamps: these are " +
        seconds_text(poses.front().stamp_s) + " to " + seconds_text(poses.back().stamp_s) +
        ", those of " + database + " " +
        (first <= last ? seconds_text(first) + " to " + seconds_text(last) : std::string("none")));
  }
  if (std::abs(alignment_->scale_found - 1) > kScaleOff) {
    warnings_.push_back(path.string() + ": fits best with a scale of " +
                        number_text(alignment_->scale_found) +
                        ", but both maps should be in metres; it was aligned without one");
  }
}

void Newcomers::place_in(const ZonePlan& plan) {
  std::vector<SignaturePlace> places;
  for (const Newcomer& newcomer : all_) {
    const Transform& T = newcomer.T_map_base;
    places.push_back({newcomer.id, {T[3], T[7]}, T[11]});
  }
  const Partition partition = packer::partition(plan.zones, places, OrphanPolicy::kNearest);
  std::set<SignatureId> orphans;
  for (const Orphan& orphan : partition.orphans) orphans.insert(orphan.id);
  for (std::size_t i = 0; i < all_.size(); ++i) {
    all_[i].zone = partition.zone_of[i];
    all_[i].orphan = orphans.contains(all_[i].id);
  }
}

}  // namespace zonepack::packer
