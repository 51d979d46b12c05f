// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace vernier::part {

/// A point of a curve and its derivatives by the curve parameter.
struct CurvePoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // mm
  Eigen::Vector3d first = Eigen::Vector3d::Zero();     // mm per unit of u
  Eigen::Vector3d second = Eigen::Vector3d::Zero();    // mm per unit of u^2
};

/// A cubic B-spline with clamped ends, equal knot spans and weights 1. Knots: {0 x4, 1/n ... (n-1)/n, 1 x4}
/// for n = control points - 3 spans. Piegl and Tiller, The NURBS Book, 2nd ed., algorithms A3.1 and A3.2.
class Spline {
 public:
  /// control: at least 4 points, mm. Throws std::invalid_argument for fewer.
  explicit Spline(std::vector<Eigen::Vector3d> control);

  /// u: 0..1; outside this range the end span continues. The second derivative is continuous, the third jumps
  /// at knots.
  CurvePoint at(double u) const;
  const std::vector<Eigen::Vector3d>& control() const { return control_; }
  std::size_t spans() const { return control_.size() - 3; }
  /// Returns the length of the whole curve, mm; Gauss-Legendre quadrature in each knot span, relative error
  /// below 1e-9.
  double length_mm() const;

 private:
  std::vector<Eigen::Vector3d> control_, first_, second_;
  std::vector<double> knots_;
};

}  // namespace vernier::part
