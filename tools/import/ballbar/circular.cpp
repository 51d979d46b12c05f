// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/ballbar/circular.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "tools/maths/decompositions.h"
#include "tools/maths/factors.h"

namespace vernier::importer {
namespace {

// Offset of the radius and centre: deviation = offset + a cos + b sin, mm.
struct FittedCircle {
  double offset = 0, a = 0, b = 0;
};

FittedCircle fit_circle(const CircularPass& pass) {
  const auto count = static_cast<Eigen::Index>(pass.angle_deg.size());
  if (pass.deviation_mm.size() != pass.angle_deg.size())
    throw std::invalid_argument("circle: the number of angles differs from the number of deviations");
  if (count < 3) throw std::invalid_argument("circle: a pass needs at least three samples");
  const Eigen::ArrayXd angle =
      Eigen::Map<const Eigen::ArrayXd>(pass.angle_deg.data(), count) * maths::kRadPerDeg;
  Eigen::MatrixXd basis(count, 3);
  basis << Eigen::VectorXd::Ones(count), angle.cos().matrix(), angle.sin().matrix();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(basis);
  if (qr.rank() < 3) throw std::invalid_argument("circle: the samples do not determine a circle");
  const Eigen::Vector3d solution =
      qr.solve(Eigen::Map<const Eigen::VectorXd>(pass.deviation_mm.data(), count));
  return {solution[0], solution[1], solution[2]};
}

// Deviation with the centre taken out, mm, of sample i.
double centred(const CircularPass& pass, const FittedCircle& circle, std::size_t i) {
  const double angle = pass.angle_deg[i] * maths::kRadPerDeg;
  return pass.deviation_mm[i] - circle.a * std::cos(angle) - circle.b * std::sin(angle);
}

CircularPassResult analyse_pass(double nominal_radius_mm, const CircularPass& pass,
                                const FittedCircle& circle) {
  CircularPassResult result;
  result.label = pass.label;
  result.direction = pass.direction;
  result.centre_a_mm = circle.a;
  result.centre_b_mm = circle.b;
  result.radius_mm = nominal_radius_mm + circle.offset;
  result.feed_mm_min = pass.feed_mm_min;
  for (std::size_t i = 0; i < pass.angle_deg.size(); ++i) {
    result.circular_um.push_back((centred(pass, circle, i) - circle.offset) * maths::kUmPerMm);
  }
  const auto [min, max] = std::minmax_element(result.circular_um.begin(), result.circular_um.end());
  result.min_circular_um = *min;
  result.max_circular_um = *max;
  result.circular_deviation_um = *max - *min;
  result.min_radial_um = *min + circle.offset * maths::kUmPerMm;
  result.max_radial_um = *max + circle.offset * maths::kUmPerMm;
  result.min_deg = pass.angle_deg[static_cast<std::size_t>(min - result.circular_um.begin())];
  result.max_deg = pass.angle_deg[static_cast<std::size_t>(max - result.circular_um.begin())];
  return result;
}

Hysteresis hysteresis_by_index(const CircularPass& ccw, const CircularPass& cw, const FittedCircle& mean) {
  Hysteresis worst{-1, 0};
  const std::size_t count = std::min(ccw.angle_deg.size(), cw.angle_deg.size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t j = cw.angle_deg.size() - 1 - i;
    const double um = std::abs(centred(ccw, mean, i) - centred(cw, mean, j)) * maths::kUmPerMm;
    if (um > worst.um) worst = {um, cw.angle_deg[j]};
  }
  return worst;
}

// Samples of one direction sorted by angle, for interpolation.
class RadiusAtAngle {
 public:
  RadiusAtAngle(const CircularPass& pass, const FittedCircle& mean) {
    std::vector<std::size_t> order(pass.angle_deg.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t i, std::size_t j) { return pass.angle_deg[i] < pass.angle_deg[j]; });
    for (const std::size_t i : order) {
      angle_.push_back(pass.angle_deg[i]);
      value_.push_back(centred(pass, mean, i));
    }
    // A gap wider than this between the last and the first sample is the open part of a partial arc.
    constexpr double kWidestGapDeg = 5;
    closed_ = angle_.front() + 360 - angle_.back() < kWidestGapDeg;
  }

  std::optional<double> at(double angle_deg) const {
    const auto above = std::lower_bound(angle_.begin(), angle_.end(), angle_deg);
    if (above != angle_.begin() && above != angle_.end()) {
      const auto i = static_cast<std::size_t>(above - angle_.begin());
      return between(angle_deg, angle_[i - 1], value_[i - 1], angle_[i], value_[i]);
    }
    if (above != angle_.end() && *above == angle_deg) return value_.front();
    if (!closed_) return std::nullopt;
    const double turned = above == angle_.begin() ? angle_deg + 360 : angle_deg;
    return between(turned, angle_.back(), value_.back(), angle_.front() + 360, value_.front());
  }

 private:
  static double between(double x, double x0, double y0, double x1, double y1) {
    return x1 > x0 ? y0 + (y1 - y0) * (x - x0) / (x1 - x0) : y0;
  }
  std::vector<double> angle_, value_;
  bool closed_ = false;
};

std::optional<Hysteresis> hysteresis_by_angle(const CircularPass& ccw, const CircularPass& cw,
                                              const FittedCircle& mean) {
  const RadiusAtAngle radius(ccw, mean);
  std::optional<Hysteresis> worst;
  for (std::size_t j = 0; j < cw.angle_deg.size(); ++j) {
    const auto other = radius.at(cw.angle_deg[j]);
    if (!other) continue;
    const double um = std::abs(*other - centred(cw, mean, j)) * maths::kUmPerMm;
    if (!worst || um > worst->um) worst = Hysteresis{um, cw.angle_deg[j]};
  }
  return worst;
}

AboutMean about_mean(const CircularPass& ccw, const CircularPass& cw, const FittedCircle& mean) {
  AboutMean result{-HUGE_VAL, HUGE_VAL, 0, 0};
  for (const CircularPass* pass : {&ccw, &cw}) {
    for (std::size_t i = 0; i < pass->angle_deg.size(); ++i) {
      const double um = (centred(*pass, mean, i) - mean.offset) * maths::kUmPerMm;
      if (um > result.max_um) result.max_um = um, result.max_deg = pass->angle_deg[i];
      if (um < result.min_um) result.min_um = um, result.min_deg = pass->angle_deg[i];
    }
  }
  return result;
}

// Radius minus nominal of the circle whose true distances from the points are least, mm: Gauss-Newton from
// the linearised circle.
double true_radius_offset(double nominal_radius_mm, const CircularPass& pass, FittedCircle circle) {
  const auto count = static_cast<Eigen::Index>(pass.angle_deg.size());
  const Eigen::ArrayXd angle =
      Eigen::Map<const Eigen::ArrayXd>(pass.angle_deg.data(), count) * maths::kRadPerDeg;
  const Eigen::ArrayXd length =
      nominal_radius_mm + Eigen::Map<const Eigen::ArrayXd>(pass.deviation_mm.data(), count);
  // An eccentricity of a thousandth of the radius shrinks a thousandfold in each step.
  constexpr int kSteps = 6;
  for (int step = 0; step < kSteps; ++step) {
    const Eigen::ArrayXd a = length * angle.cos() - circle.a, b = length * angle.sin() - circle.b;
    const Eigen::ArrayXd radius = (a.square() + b.square()).sqrt();
    Eigen::MatrixXd basis(count, 3);
    basis << Eigen::VectorXd::Ones(count), (a / radius).matrix(), (b / radius).matrix();
    const Eigen::Vector3d change =
        maths::least_squares(basis, (radius - nominal_radius_mm - circle.offset).matrix());
    circle.offset += change[0], circle.a += change[1], circle.b += change[2];
  }
  return circle.offset;
}

}  // namespace

CircularResult analyse_circle(double nominal_radius_mm, const std::vector<CircularPass>& passes) {
  CircularResult result;
  result.nominal_radius_mm = nominal_radius_mm;
  std::vector<FittedCircle> circles;
  std::optional<std::size_t> first_ccw, first_cw;
  for (std::size_t i = 0; i < passes.size(); ++i) {
    circles.push_back(fit_circle(passes[i]));
    result.passes.push_back(analyse_pass(nominal_radius_mm, passes[i], circles.back()));
    auto& first = passes[i].direction > 0 ? first_ccw : first_cw;
    if (!first) first = i;
  }
  if (!first_ccw || !first_cw) return result;
  const CircularPassResult &a = result.passes[*first_ccw], &b = result.passes[*first_cw];
  result.bidirectional_um =
      std::max(a.max_circular_um, b.max_circular_um) - std::min(a.min_circular_um, b.min_circular_um);
  const FittedCircle &ca = circles[*first_ccw], &cb = circles[*first_cw];
  const FittedCircle mean{(ca.offset + cb.offset) / 2, (ca.a + cb.a) / 2, (ca.b + cb.b) / 2};
  result.mean_centre_a_mm = mean.a;
  result.mean_centre_b_mm = mean.b;
  result.mean_radius_mm = nominal_radius_mm + mean.offset;
  result.about_mean = about_mean(passes[*first_ccw], passes[*first_cw], mean);
  result.mean_bidirectional_radial_um = maths::kUmPerMm *
                                        (true_radius_offset(nominal_radius_mm, passes[*first_ccw], ca) +
                                         true_radius_offset(nominal_radius_mm, passes[*first_cw], cb)) /
                                        2;
  result.hysteresis = hysteresis_by_index(passes[*first_ccw], passes[*first_cw], mean);
  result.hysteresis_by_angle = hysteresis_by_angle(passes[*first_ccw], passes[*first_cw], mean);
  return result;
}

}  // namespace vernier::importer
