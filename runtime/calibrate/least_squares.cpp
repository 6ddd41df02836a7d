// SPDX-License-Identifier: Apache-2.0
#include "runtime/calibrate/least_squares.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace zonepack {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd evaluate(const Residuals& residuals_of, const VectorXd& at) {
  const std::vector<double> values = residuals_of({at.data(), static_cast<std::size_t>(at.size())});
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

MatrixXd slopes(const Residuals& residuals_of, const VectorXd& at, const VectorXd& residuals) {
  constexpr double kStep = 1e-6;
  MatrixXd jacobian(residuals.size(), at.size());
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    VectorXd beside = at;
    beside[i] += kStep;
    jacobian.col(i) = (evaluate(residuals_of, beside) - residuals) / kStep;
  }
  return jacobian;
}

}  // namespace

std::optional<LeastSquares> solve_least_squares(std::vector<double> start,
                                                const Residuals& residuals_of) {
  constexpr int kMostRounds = 30;
  constexpr double kDone = 1e-9;
  constexpr double kLeastRank = 1e-12;
  VectorXd at = Eigen::Map<VectorXd>(start.data(), static_cast<Eigen::Index>(start.size()));
  for (int round = 0; round < kMostRounds; ++round) {
    const VectorXd residuals = evaluate(residuals_of, at);
    const MatrixXd jacobian = slopes(residuals_of, at, residuals);
    const MatrixXd normal = jacobian.transpose() * jacobian;
    const Eigen::LDLT<MatrixXd> solver(normal);
    if (residuals.size() <= at.size() || !(solver.rcond() > kLeastRank)) return std::nullopt;
    const VectorXd step = solver.solve(-(jacobian.transpose() * residuals));
    at += step;
    if (!at.allFinite()) return std::nullopt;
    if (step.cwiseAbs().maxCoeff() > kDone) continue;
    const double variance =
        residuals.squaredNorm() / static_cast<double>(residuals.size() - at.size());
    const MatrixXd covariance = solver.solve(MatrixXd::Identity(at.size(), at.size())) * variance;
    LeastSquares found;
    found.parameters.assign(at.data(), at.data() + at.size());
    for (Eigen::Index i = 0; i < at.size(); ++i) {
      found.sigmas.push_back(std::sqrt(covariance(i, i)));
    }
    return found;
  }
  return std::nullopt;
}

}  // namespace zonepack
