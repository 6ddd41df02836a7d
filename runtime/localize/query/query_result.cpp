// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/query/query_result.hpp"

namespace zonepack::localize {

const char* to_string(Reason reason) noexcept {
  switch (reason) {
    case Reason::kAccepted:
      return "accepted";
    case Reason::kWrongSize:
      return "wrong_size";
    case Reason::kNoFeatures:
      return "no_features";
    case Reason::kNoSignature:
      return "no_signature";
    case Reason::kNotInView:
      return "not_in_view";
    case Reason::kFewMatches:
      return "few_matches";
    case Reason::kFewInliers:
      return "few_inliers";
    case Reason::kChance:
      return "chance";
    case Reason::kGathered:
      return "gathered";
    case Reason::kFarFromPrior:
      return "far_from_prior";
    case Reason::kNotLevel:
      return "not_level";
    case Reason::kUnsure:
      return "unsure";
    case Reason::kRival:
      return "rival";
  }
  return "?";
}

const char* to_string(Stage stage) noexcept {
  switch (stage) {
    case Stage::kDetect:
      return "detect";
    case Stage::kDescribe:
      return "describe";
    case Stage::kSelect:
      return "select";
    case Stage::kMatch:
      return "match";
    case Stage::kRansac:
      return "ransac";
    case Stage::kRefine:
      return "refine";
  }
  return "?";
}

}  // namespace zonepack::localize
