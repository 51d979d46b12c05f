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

/// A cubic B-spline with clamped ends, equal knot spans and all weights equal to 1. The knots are {0 x4, 1/n
/// ... (n-1)/n, 1 x4}, with n = control points - 3 spans. The algorithms are A3.1 and A3.2 of Piegl and
/// Tiller, The NURBS Book, 2nd ed.
class Spline {
 public:
  /// `control`: at least 4 control points, mm. Throws std::invalid_argument if there are fewer than 4 control
  /// points.
  explicit Spline(std::vector<Eigen::Vector3d> control);

  /// `u`: 0..1. For u outside 0..1, the polynomial of the end span is used. The second derivative of the
  /// spline is continuous; the third derivative jumps at knots.
  CurvePoint at(double u) const;
  const std::vector<Eigen::Vector3d>& control() const { return control_; }
  std::size_t spans() const { return control_.size() - 3; }
  /// Returns the length of the whole curve, mm. The method is Gauss-Legendre quadrature in each knot span,
  /// with a relative error below 1e-9.
  double length_mm() const;

 private:
  std::vector<Eigen::Vector3d> control_, first_, second_;
  std::vector<double> knots_;
};

}  // namespace vernier::part
