// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::exchange {

/// A smooth surface z(x, y) through points (thin-plate spline, Duchon 1977): a plane, plus the sum of
/// r^2 log r over the points.
class Surface {
 public:
  Surface() = default;
  /// `points`: x, y, z in mm, one column for each point. Points closer than 1 mm are averaged. With three
  /// points or fewer the surface is horizontal.
  explicit Surface(const Eigen::Matrix3Xd& points);

  double at(double x, double y) const;

 private:
  Eigen::Matrix2Xd knots_;
  Eigen::VectorXd weight_;
  Eigen::Vector3d plane_ = Eigen::Vector3d::Zero();  // height, slopes
  Eigen::Vector2d middle_ = Eigen::Vector2d::Zero();
  double scale_ = 1;
};

/// One touch of the bed: the touched point by the model of the machine, in workpiece coordinates, mm.
struct BedTouch {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d nominal = Eigen::Vector3d::Zero();  // the touched point by the nominal machine
  /// Position of the probe minus position of the nozzle, mm; 0: the nozzle touched.
  std::array<double, 2> offset{};
  bool check = false;

  bool of_nozzle() const { return offset[0] == 0 && offset[1] == 0; }
};

/// Heights of the bed that the nozzle has to follow, from touches of the nozzle or of a probe beside the
/// nozzle. Touches of a probe give the shape of the bed, plus the error of the machine at the probe that the
/// model lacks. Touches of the nozzle at some points give the difference of this error between probe and
/// nozzle: a polynomial over X and Y of degree 2 or less.
class BedShape {
 public:
  /// Throws InputError if the fit rows have fewer than three touches of the bed.
  explicit BedShape(const std::vector<BedTouch>& touches);

  /// Height at x and y of workpiece coordinates, mm.
  double height(double x, double y) const;

  /// Ranges of the touched points, mm.
  std::array<double, 2> low{}, high{};
  std::size_t by_probe = 0, by_nozzle = 0;  // numbers of touches in fit rows
  std::size_t checks = 0;                   // number of touches of the nozzle in check rows
  double check_rms_um = 0;                  // heights at these check rows without a constant offset, um
  /// Rms of the touches of one place about their mean, um; 0 if no place was touched twice
  double repeat_rms_um = 0;
  std::array<double, 2> offset{};  // of the probe; 0 without touches of a probe
  /// Half of the range of the heights that touches of a probe alone do not determine, um; 0 if fit rows touch
  /// with the nozzle too. For the nominal machine: the model is not confirmed at the nozzle. The touches do
  /// not show whether a height belongs to the bed (at the touched point) or to a carriage (at the position of
  /// the axes).
  double undetermined_um = 0;

 private:
  void add_difference(const std::vector<BedTouch>& touches);
  void judge(const std::vector<BedTouch>& touches);
  void judge_repeats(const std::vector<BedTouch>& touches);

  Surface surface_;
  Eigen::VectorXd difference_;              // coefficients of the polynomial
  std::vector<std::array<int, 2>> powers_;  // exponents of x and y of each coefficient
  Eigen::Vector2d middle_ = Eigen::Vector2d::Zero(), half_ = Eigen::Vector2d::Ones();
};

/// Returns the touches of an artefact in a measurement, by the model of the machine with the probe of each
/// row.
std::vector<BedTouch> bed_touches(const model::Machine& machine, const model::Measurement& rows,
                                  const std::string& artefact);

}  // namespace vernier::exchange
