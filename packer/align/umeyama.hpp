// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "packer/record/record.hpp"

// The rigid or similarity transform between two sets of corresponding points, in the least squares
// sense.
namespace zonepack::packer {

using Point3 = std::array<double, 3>;  // metres

// p_to = scale * rotation * p_from + translation.
struct PointTransform {
  std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};  // row-major
  Point3 translation{};
  double scale = 1;

  Point3 operator()(const Point3& p_from) const noexcept;
  // The pose of a base in the frame `to`; its rotation is not scaled.
  Transform operator()(const Transform& T_from_base) const noexcept;
};

enum class FitModel { kRigid, kSimilarity };

struct PointFit {
  PointTransform T_to_from;
  double scale_found = 1;           // of the similarity, also where a rigid transform is returned
  double rms_m = 0;                 // of the residuals, in the frame `to`
  double largest_m = 0;             // the largest residual
  std::vector<double> residuals_m;  // of each pair, in their order
};

// The transform that takes `from` to `to`, where from[i] and to[i] are the same place.
//
// Source: S. Umeyama, "Least-squares estimation of transformation parameters between two point
// patterns" (PAMI 1991); the rotation is found as the eigenvector of a symmetric 4x4 matrix after
// B. K. P. Horn, "Closed-form solution of absolute orientation using unit quaternions" (JOSA A
// 1987), which never gives a reflection. Only + - * / sqrt: the same bits on every machine.
//
// Throws std::runtime_error, a text that continues "the alignment ...", when there are fewer than
// three pairs, a coordinate is not finite, or the points of one side lie on one line, about which
// the rotation would be free.
PointFit fit_points(std::span<const Point3> from, std::span<const Point3> to, FitModel model);

}  // namespace zonepack::packer
