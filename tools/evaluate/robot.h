// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vernier::evaluate {

/// One visit of a pose, or one sample of a path: the commanded and the measured pose of the robot. mm;
/// rotations as rotation vectors, deg.
struct PoseReading {
  std::string run;  // the cycle that it belongs to
  Eigen::Vector3d commanded_mm, measured_mm;
  std::optional<Eigen::Vector3d> commanded_deg, measured_deg;
  double u_mm = 0;  // standard uncertainty of a measured coordinate; 0: not known
  double time_s = std::numeric_limits<double>::quiet_NaN();  // not a number if it is not known
};

/// Results of ISO 9283:1998, 7.2 at one pose. mm, deg.
struct PoseResult {
  Eigen::Vector3d commanded_mm;
  std::size_t count = 0;
  Eigen::Vector3d deviation_mm;                                    // AP_x AP_y AP_z: barycentre - commanded
  double accuracy_mm = 0;                                          // AP_P: its length
  double scatter_std_mm = 0;                                       // of it: scatter of the mean along it
  double accuracy_std_mm = 0;                                      // the same and u of the instrument
  double mean_distance_mm = 0;                                     // of the readings from their barycentre
  double distance_spread_mm = 0;                                   // S_l, n - 1
  double repeatability_mm = 0;                                     // RP_l: mean distance + 3 S_l
  double low_mm = 0, high_mm = 0;                                  // 95 % interval of RP_l
  double freedom = 0;                                              // of the chi square that it is from
  std::optional<Eigen::Vector3d> accuracy_deg, repeatability_deg;  // AP_a b c; RP_a b c: 3 S of each
};

/// Returns the visits of each pose. Poses and visits are in the order of the readings. The pointers refer to
/// `readings`.
std::vector<std::vector<const PoseReading*>> visits_by_pose(const std::vector<PoseReading>& readings);

/// Returns the 95 % interval of a standard deviation, or of a multiple of one. freedom: degrees of freedom.
std::pair<double, double> spread_interval(double spread, double freedom);

/// Returns the poses of a test in the order of their first visit. Readings with one commanded pose (within 1
/// nm and 1 nrad) belong together. Throws InputError: a pose with fewer than two readings. The interval
/// assumes normal scatter with the observed covariance. The degrees of freedom of RP_l are chosen so that chi
/// square has the same variance as RP_l. Source: ISO 9283:1998, 7.2.1, 7.2.2; the interval by the delta
/// method.
std::vector<PoseResult> evaluate_poses(const std::vector<PoseReading>& readings);

/// Rotates and shifts all measured poses together, so that the sum of the squared distances between measured
/// and commanded positions is smallest (Kabsch 1976). Used for an instrument whose frame is not
/// that of the robot. Throws InputError if the poses do not determine a frame (fewer than three poses, or all
/// on one line).
void align_to_commanded(std::vector<PoseReading>& readings);

}  // namespace vernier::evaluate
