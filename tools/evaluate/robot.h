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

/// One visit of a pose, or one sample of a path: the commanded and the measured pose of the robot. Positions
/// are in mm; rotations are rotation vectors in deg.
struct PoseReading {
  std::string run;  // label of the cycle to which the reading belongs
  Eigen::Vector3d commanded_mm, measured_mm;
  std::optional<Eigen::Vector3d> commanded_deg, measured_deg;
  double u_mm = 0;  // standard uncertainty of a measured coordinate; 0: unknown
  double time_s = std::numeric_limits<double>::quiet_NaN();  // NaN if the time is unknown
};

/// Results of ISO 9283:1998, 7.2 at one pose, in mm and deg.
struct PoseResult {
  Eigen::Vector3d commanded_mm;
  std::size_t count = 0;
  Eigen::Vector3d deviation_mm;                                    // AP_x, AP_y, AP_z: barycentre minus
                                                                   // commanded position
  double accuracy_mm = 0;                                          // AP_P: length of the deviation
  double scatter_std_mm = 0;                                       // standard deviation of AP_P from the
                                                                   // scatter of the mean
  double accuracy_std_mm = 0;                                      // standard uncertainty of AP_P from the
                                                                   // scatter and from u of the instrument
  double mean_distance_mm = 0;                                     // mean distance of the readings from their
                                                                   // barycentre
  double distance_spread_mm = 0;                                   // S_l: standard deviation of these
                                                                   // distances (n - 1)
  double repeatability_mm = 0;                                     // RP_l: mean distance + 3 S_l
  double low_mm = 0, high_mm = 0;                                  // ends of the 95 % interval of RP_l
  double freedom = 0;                                              // degrees of freedom of the chi-square
                                                                   // distribution for this interval
  std::optional<Eigen::Vector3d> accuracy_deg, repeatability_deg;  // AP_a b c, and RP_a b c as 3 S of each
                                                                   // component
};

/// Returns the visits of each pose in a robot test. The poses and visits are in the order of the readings.
/// The returned pointers are valid while `readings` exists.
std::vector<std::vector<const PoseReading*>> visits_by_pose(const std::vector<PoseReading>& readings);

/// Returns the 95 % interval of a standard deviation, or of a multiple of a standard deviation. `freedom`:
/// degrees of freedom.
std::pair<double, double> spread_interval(double spread, double freedom);

/// Returns the results for the poses of a test, in the order of their first visit. Readings with the same
/// commanded pose (within 1 nm and 1 nrad) belong to one pose. Throws InputError if a pose has fewer than two
/// readings. The interval of RP_l is valid for normal scatter with the observed covariance. The degrees of
/// freedom of RP_l are those with which chi square has the same variance as RP_l. The definitions are those
/// of ISO 9283:1998, 7.2.1 and 7.2.2. The interval is computed by the delta method.
std::vector<PoseResult> evaluate_poses(const std::vector<PoseReading>& readings);

/// Rotates and shifts all measured poses together. The rotation and shift minimise the sum of the squared
/// distances between measured and commanded positions (Kabsch 1976). The function is used if the frame of
/// the instrument is not that of the robot. Throws InputError if the poses do not determine a frame (fewer
/// than three poses, or all on one line).
void align_to_commanded(std::vector<PoseReading>& readings);

}  // namespace vernier::evaluate
