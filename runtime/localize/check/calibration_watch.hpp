// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "runtime/localize/camera/camera_model.hpp"
#include "runtime/localize/query/query_result.hpp"

namespace zonepack::localize {

// What a calibration may say wrongly and a fix still be found. Not: where the camera sits in the
// plane and where it looks, which the pose itself takes up.
enum class CameraTrait : std::uint8_t {
  kFocal,   // share by which fx and fy are larger than the calibration says
  kHeight,  // metres by which the camera sits higher
  kPitch,   // radians by which it looks lower: a turn about base_link's y, which points left
  kRoll,    // radians by which it leans to the right: a turn about base_link's x, which is ahead
};
inline constexpr std::size_t kCameraTraits = 4;
using CameraTraits = std::array<double, kCameraTraits>;
// As in the JSON: "focal", "height", "pitch", "roll".
const char* to_string(CameraTrait trait) noexcept;

// The camera as it is when the calibration is off by this much.
CameraModel corrected(const CameraModel& camera, const CameraTraits& by);

// What a calibration is off by.
struct CalibrationFinding {
  CameraTrait trait = CameraTrait::kFocal;
  double value = 0, sigma = 0;
};

struct CalibrationReport {
  std::size_t fixes = 0;
  bool enough = false;  // of them, to say anything
  // Significant ones, estimated together; the clearest first. Empty: nothing is wrong.
  std::vector<CalibrationFinding> findings;
  // Each on its own, as if the others were right: what was tested.
  std::array<CalibrationFinding, kCameraTraits> each{};
};

// Significant, and more than least_of_note().
bool is_clear(const CalibrationFinding& finding) noexcept;
// 0.6 %, 1.2 cm, 0.2 degrees: less does no harm, and maps are off by as much themselves.
double least_of_note(CameraTrait trait) noexcept;

// Looks over many fixes for what a wrong calibration leaves in all of them.
//
// Each fix gives the normal equations of the four traits, from the residuals of its inliers and
// the robot's height and tilt over a level floor, with the pose's six degrees of freedom
// eliminated (Schur complement). The sum over the fixes is solved. Its noise is not that of pixels,
// as the map's own errors are shared by fixes near each other: so it is taken from how much groups
// of consecutive fixes disagree (the cluster-robust "sandwich" estimate), and what maps are off by
// as a whole is added. A trait counts when it is over kSignificant standard deviations and of note;
// of several the clearest is taken first, and another only when it is still significant next to it.
//
// Memory: at most kMostGroups groups of 14 numbers: when they are full, two make one.
// Threads: one.
class CalibrationWatch {
 public:
  static constexpr double kSignificant = 3.5;  // standard deviations: 1 in 2000 by chance
  static constexpr std::size_t kMostGroups = 32, kLeastGroups = 10, kFixesOfGroup = 4;

  // Takes a query with QueryOptions::keep_matches; ignores one that was not accepted.
  void add(const CameraModel& camera, const QueryResult& fix);

  std::size_t fixes() const noexcept { return fixes_; }
  CalibrationReport report() const;

  // These traits estimated together, in their order, significant or not. Empty without fixes.
  std::vector<CalibrationFinding> together(const std::vector<CameraTrait>& traits) const;

 private:
  using Matrix = Eigen::Matrix<double, kCameraTraits, kCameraTraits>;
  using Vector = Eigen::Matrix<double, kCameraTraits, 1>;
  struct Normal {
    Matrix information = Matrix::Zero();
    Vector gradient = Vector::Zero();
    std::size_t fixes = 0;
    void add(const Normal& other);
  };
  using Subset = std::vector<CameraTrait>;
  struct Estimate {
    std::vector<CalibrationFinding> values;  // in the subset's order
    double explained = 0;                    // of the sum of squares
  };
  static Normal normal_of(const CameraModel& camera, const QueryResult& fix);
  std::optional<Estimate> estimate(const Subset& subset) const;

  std::vector<Normal> groups_;
  std::size_t fixes_of_group_ = kFixesOfGroup;
  std::size_t fixes_ = 0;
};

}  // namespace zonepack::localize
