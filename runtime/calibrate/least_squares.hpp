// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace zonepack {

struct LeastSquares {
  std::vector<double> parameters;
  std::vector<double> sigmas;  // standard deviations, scaled by how large the residuals are
};

// The parameters, near those given, at which the residuals' sum of squares is least (Gauss-Newton
// with finite differences). Nothing when they cannot be determined, or no solution is near.
using Residuals = std::function<std::vector<double>(std::span<const double>)>;
std::optional<LeastSquares> solve_least_squares(std::vector<double> start,
                                                const Residuals& residuals_of);

}  // namespace zonepack
