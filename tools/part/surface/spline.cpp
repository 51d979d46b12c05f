// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/part/surface/spline.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace vernier::part {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// Control points of the derivative of a spline of `degree` on `knots` (A3.3): differences over knot spans.
Points derivative(const Points& control, const std::vector<double>& knots, std::size_t degree,
                  std::size_t dropped) {
  Points result;
  for (std::size_t i = 0; i + 1 < control.size(); ++i)
    result.push_back(static_cast<double>(degree) * (control[i + 1] - control[i]) /
                     (knots[i + 1 + degree + dropped] - knots[i + 1 + dropped]));
  return result;
}

/// Value of a spline of `degree` in the knot span `k` of the full knot vector. A derivative has `dropped`
/// knots less at either end, so its control points sit `dropped` further left.
Eigen::Vector3d de_boor(const Points& control, const std::vector<double>& knots, std::size_t degree,
                        std::size_t dropped, std::size_t k, double u) {
  std::array<Eigen::Vector3d, 4> d;
  for (std::size_t j = 0; j <= degree; ++j) d[j] = control[k - degree - dropped + j];
  for (std::size_t r = 1; r <= degree; ++r)
    for (std::size_t j = degree; j >= r; --j) {
      const double low = knots[k - degree + j], high = knots[k + 1 + j - r];
      const double share = (u - low) / (high - low);
      d[j] = (1 - share) * d[j - 1] + share * d[j];
    }
  return d[degree];
}

/// Nodes and weights of the 8-point Gauss-Legendre rule on -1..1, the positive half (Abramowitz and Stegun,
/// table 25.4).
constexpr std::array<double, 4> kNode = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                         0.9602898564975363};
constexpr std::array<double, 4> kWeight = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                           0.1012285362903763};
constexpr std::size_t kPiecesPerSpan = 8;  // of the quadrature, eight nodes in each

}  // namespace

Spline::Spline(std::vector<Eigen::Vector3d> control) : control_(std::move(control)) {
  if (control_.size() < 4) throw std::invalid_argument("a cubic spline needs at least 4 control points");
  knots_.assign(4, 0.0);
  for (std::size_t i = 1; i < spans(); ++i)
    knots_.push_back(static_cast<double>(i) / static_cast<double>(spans()));
  knots_.insert(knots_.end(), 4, 1.0);
  first_ = derivative(control_, knots_, 3, 0);
  second_ = derivative(first_, knots_, 2, 1);
}

CurvePoint Spline::at(double u) const {
  const auto n = static_cast<double>(spans());
  const auto span = static_cast<std::size_t>(std::clamp(u * n, 0.0, n - 1));
  const std::size_t k = 3 + span;
  return {de_boor(control_, knots_, 3, 0, k, u), de_boor(first_, knots_, 2, 1, k, u),
          de_boor(second_, knots_, 1, 2, k, u)};
}

double Spline::length_mm() const {
  const std::size_t pieces = kPiecesPerSpan * spans();
  const double half = 0.5 / static_cast<double>(pieces);
  double length = 0;
  for (std::size_t i = 0; i < pieces; ++i) {
    const double middle = (2 * static_cast<double>(i) + 1) * half;
    for (std::size_t g = 0; g < kNode.size(); ++g)
      length += half * kWeight[g] *
                (at(middle - half * kNode[g]).first.norm() + at(middle + half * kNode[g]).first.norm());
  }
  return length;
}

}  // namespace vernier::part
