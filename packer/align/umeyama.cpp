// SPDX-License-Identifier: Apache-2.0
#include "packer/align/umeyama.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace zonepack::packer {
namespace {

constexpr std::size_t kLeastMoments = 3;
// Points whose second widest spread is below this part of the widest lie on one line.
constexpr double kLineSpread = 1e-4;

Point3 mean_of(std::span<const Point3> points) {
  Point3 sum{};
  for (const Point3& p : points) {
    for (std::size_t k = 0; k < 3; ++k) sum[k] += p[k];
  }
  for (double& value : sum) value /= static_cast<double>(points.size());
  return sum;
}

// Eigenvalues and eigenvectors (columns) of a symmetric matrix by cyclic Jacobi rotations.
template <std::size_t N>
struct Spectrum {
  std::array<double, N> values{};
  std::array<std::array<double, N>, N> vectors{};
};

template <std::size_t N>
Spectrum<N> eigen_of(std::array<std::array<double, N>, N> a) {
  constexpr int kMostSweeps = 64;  // ten suffice for any matrix of this size
  Spectrum<N> result;
  for (std::size_t i = 0; i < N; ++i) result.vectors[i][i] = 1;
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double off = 0;
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t j = i + 1; j < N; ++j) off += a[i][j] * a[i][j];
    }
    if (off == 0) break;
    for (std::size_t p = 0; p < N; ++p) {
      for (std::size_t q = p + 1; q < N; ++q) {
        if (a[p][q] == 0) continue;
        const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1);
        const double s = t * c;
        for (std::size_t k = 0; k < N; ++k) {
          const double kp = a[k][p], kq = a[k][q];
          a[k][p] = c * kp - s * kq;
          a[k][q] = s * kp + c * kq;
        }
        for (std::size_t k = 0; k < N; ++k) {
          const double pk = a[p][k], qk = a[q][k];
          a[p][k] = c * pk - s * qk;
          a[q][k] = s * pk + c * qk;
        }
        for (std::size_t k = 0; k < N; ++k) {
          const double kp = result.vectors[k][p], kq = result.vectors[k][q];
          result.vectors[k][p] = c * kp - s * kq;
          result.vectors[k][q] = s * kp + c * kq;
        }
      }
    }
  }
  for (std::size_t i = 0; i < N; ++i) result.values[i] = a[i][i];
  return result;
}

void refuse_line(std::span<const Point3> points, const Point3& mean, const char* which) {
  std::array<std::array<double, 3>, 3> spread{};
  for (const Point3& p : points) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) spread[i][j] += (p[i] - mean[i]) * (p[j] - mean[j]);
    }
  }
  auto values = eigen_of<3>(spread).values;
  std::sort(values.begin(), values.end());
  if (values[1] > kLineSpread * kLineSpread * values[2]) return;
  throw std::runtime_error(std::string("is not determined: the ") + which +
                           " positions lie on one line or at one place, so nothing says how the "
                           "map is turned about it; give positions of a path with a turn");
}

std::array<double, 9> rotation_of(const std::array<double, 4>& q) {
  const auto [w, x, y, z] = q;
  return {
      w * w + x * x - y * y - z * z, 2 * (x * y - w * z),           2 * (x * z + w * y),
      2 * (x * y + w * z),           w * w - x * x + y * y - z * z, 2 * (y * z - w * x),
      2 * (x * z - w * y),           2 * (y * z + w * x),           w * w - x * x - y * y + z * z};
}

}  // namespace

Point3 PointTransform::operator()(const Point3& p) const noexcept {
  Point3 out;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t row = 3 * i;
    out[i] = scale * (rotation[row] * p[0] + rotation[row + 1] * p[1] + rotation[row + 2] * p[2]) +
             translation[i];
  }
  return out;
}

Transform PointTransform::operator()(const Transform& T) const noexcept {
  Transform out;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        sum += rotation[3 * i + k] * static_cast<double>(T[4 * k + j]);
      }
      out[4 * i + j] = static_cast<float>(sum);
    }
  }
  const Point3 place = (*this)(Point3{T[3], T[7], T[11]});
  for (std::size_t i = 0; i < 3; ++i) out[4 * i + 3] = static_cast<float>(place[i]);
  return out;
}

PointFit fit_points(std::span<const Point3> from, std::span<const Point3> to, FitModel model) {
  const std::size_t pairs = std::min(from.size(), to.size());
  if (pairs < kLeastMoments) {
    throw std::runtime_error("needs " + std::to_string(kLeastMoments) +
                             " positions known in both frames, found " + std::to_string(pairs));
  }
  for (const auto points : {from, to}) {
    for (const Point3& p : points) {
      if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) continue;
      throw std::runtime_error("needs finite positions, found one that is not");
    }
  }
  const Point3 mean_from = mean_of(from), mean_to = mean_of(to);
  refuse_line(from, mean_from, "map's");
  refuse_line(to, mean_to, "trajectory's");

  // s[i][j]: sum of from_i * to_j about the means.
  std::array<std::array<double, 3>, 3> s{};
  double spread_from = 0;
  for (std::size_t n = 0; n < pairs; ++n) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double a = from[n][i] - mean_from[i];
      spread_from += a * a;
      for (std::size_t j = 0; j < 3; ++j) s[i][j] += a * (to[n][j] - mean_to[j]);
    }
  }
  std::array<std::array<double, 4>, 4> horn{};
  horn[0] = {s[0][0] + s[1][1] + s[2][2], s[1][2] - s[2][1], s[2][0] - s[0][2], s[0][1] - s[1][0]};
  horn[1] = {horn[0][1], s[0][0] - s[1][1] - s[2][2], s[0][1] + s[1][0], s[2][0] + s[0][2]};
  horn[2] = {horn[0][2], horn[1][2], -s[0][0] + s[1][1] - s[2][2], s[1][2] + s[2][1]};
  horn[3] = {horn[0][3], horn[1][3], horn[2][3], -s[0][0] - s[1][1] + s[2][2]};
  const auto eigen = eigen_of<4>(horn);
  const auto best = static_cast<std::size_t>(
      std::max_element(eigen.values.begin(), eigen.values.end()) - eigen.values.begin());
  std::array<double, 4> q{};
  double length = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    q[i] = eigen.vectors[i][best];
    length += q[i] * q[i];
  }
  for (double& value : q) value /= std::sqrt(length);

  PointFit result;
  PointTransform& T = result.T_to_from;
  T.rotation = rotation_of(q);
  double along = 0;  // sum of to . R from about the means
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) along += T.rotation[3 * j + i] * s[i][j];
  }
  result.scale_found = along / spread_from;
  T.scale = model == FitModel::kSimilarity ? result.scale_found : 1;
  const Point3 turned = T(mean_from);
  for (std::size_t i = 0; i < 3; ++i) T.translation[i] = mean_to[i] - turned[i];

  double sum = 0;
  for (std::size_t n = 0; n < pairs; ++n) {
    const Point3 p = T(from[n]);
    double squared = 0;
    for (std::size_t i = 0; i < 3; ++i) squared += (p[i] - to[n][i]) * (p[i] - to[n][i]);
    sum += squared;
    result.residuals_m.push_back(std::sqrt(squared));
    result.largest_m = std::max(result.largest_m, result.residuals_m.back());
  }
  result.rms_m = std::sqrt(sum / static_cast<double>(pairs));
  return result;
}

}  // namespace zonepack::packer
