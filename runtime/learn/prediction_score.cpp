// SPDX-License-Identifier: Apache-2.0
#include "runtime/learn/prediction_score.hpp"

#include <algorithm>

namespace zonepack {

PredictionScore score_drive(const ZoneDrive& drive, Transitions& known, bool learns) {
  PredictionScore score;
  ZoneSteps steps;
  const ZoneGraph& graph = known.graph();
  for (const ZoneDrive::Visit& visit : drive.visits) {
    const ZoneSteps::Step* const step = steps.enter(graph, graph.find(visit.zone), visit.t_ns);
    if (step == nullptr) continue;
    const Successors guess = known.after(step->before, step->now);
    ++score.steps;
    if (!guess.empty() && guess[0].zone == step->next) ++score.first;
    for (std::size_t i = 0; i < guess.size() && i < 2; ++i) {
      if (guess[i].zone == step->next) ++score.first_two;
    }
    if (learns) known.learn(step->before, step->now, step->next, step->stay_ns);
  }
  return score;
}

void learn_drive(const ZoneDrive& drive, Transitions& into) { score_drive(drive, into, true); }

std::vector<std::string> unknown_zones(const ZoneDrive& drive, const ZoneGraph& graph) {
  std::vector<std::string> unknown;
  for (const ZoneDrive::Visit& visit : drive.visits) {
    if (!visit.zone.empty() && graph.find(visit.zone) == kNoZone) unknown.push_back(visit.zone);
  }
  std::ranges::sort(unknown);
  unknown.erase(std::unique(unknown.begin(), unknown.end()), unknown.end());
  return unknown;
}

}  // namespace zonepack
