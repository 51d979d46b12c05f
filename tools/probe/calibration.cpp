// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/probe/calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/maths/chance.h"
#include "tools/maths/factors.h"
#include "tools/text/error.h"

namespace vernier::probe {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Feeds that differ by less than this give no information about the delay.
constexpr double kLeastFeedSpread = 0.05;
/// A gap in the azimuths, or a span of the threefold angle, from which lobes cannot be distinguished from an
/// eccentric centre.
constexpr double kLargestGapDeg = 100;
constexpr double kLobeChance = 0.01, kGroupChance = 0.01;

bool varies(const VectorXd& values) {
  const double high = values.maxCoeff(), low = values.minCoeff();
  return high - low > kLeastFeedSpread * std::max(std::abs(high), std::abs(low));
}

/// Columns of the design that the touches can determine.
struct LeverReach {
  bool delay = false, lobes = false;
};

void say_feeds(const VectorXd& feed, bool delay, std::vector<std::string>& findings) {
  if (!delay) {
    findings.push_back(
        fmt::format("All touches have a feed near {:.0f} mm/min: the delay cannot be distinguished from "
                    "pretravel and tip radius. The effective tip radius is valid at this feed only. Repeat "
                    "the touches at a feed that is at least twice or at most half as fast.",
                    feed.mean()));
  } else if (feed.maxCoeff() < 2 * feed.minCoeff()) {
    findings.push_back(
        fmt::format("The feeds are only from {:.0f} to {:.0f} mm/min, so delay and pretravel are correlated; "
                    "a wider range of feeds reduces the uncertainty of both.",
                    feed.minCoeff(), feed.maxCoeff()));
  }
}

void add(ProbeCalibration& result, const std::string& name, const std::string& unit, double factor, Index i,
         double offset = 0) {
  result.parameters.push_back(
      {name, unit, factor * result.fit.value(i) + offset, std::abs(factor) * result.fit.std_of(i)});
}

// Does a model with additional parameters explain more than chance? Both models must be fitted to
// the same touches.
bool explains(const TouchFit& with, const TouchFit& without, double level) {
  const double more = without.sigma * without.sigma * without.dof - with.sigma * with.sigma * with.dof;
  const int extra = without.dof - with.dof;
  if (extra <= 0 || with.dof <= 0 || with.sigma <= 0) return false;
  return std::exp(maths::log_f_tail(std::max(0.0, more / extra / (with.sigma * with.sigma)), extra,
                                    with.dof)) < level;
}

/// Adds the standard deviation of the delay from touch to touch: the part of the residuals'
/// variance that grows with the square of the speed (mm/s). `touches`: number in one observation.
void add_spread(ProbeCalibration& result, const VectorXd& speed, double touches) {
  if (!result.delay_found) return;
  // Squares of residuals as a function of 1 and speed^2, weighted by the scatter of each (2
  // variance^2). The parameters absorbed a part.
  const double lost = static_cast<double>(speed.size()) / std::max(1, result.fit.dof);
  Eigen::Vector2d variance(result.fit.sigma * result.fit.sigma, 0);
  Eigen::Matrix2d inverse = Eigen::Matrix2d::Zero();
  constexpr int kRounds = 20;  // of alternating weights and fit, at most
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    for (Index i = 0; i < speed.size(); ++i) {
      if (!result.fit.kept[static_cast<std::size_t>(i)]) continue;
      const Eigen::Vector2d row(1, speed(i) * speed(i));
      const double here = std::max(row.dot(variance), 1e-3 * result.fit.sigma * result.fit.sigma);
      const double weight = 1 / (2 * here * here);
      normal += weight * row * row.transpose();
      right += weight * lost * result.fit.residual(i) * result.fit.residual(i) * row;
    }
    inverse = normal.inverse();
    variance = (inverse * right).cwiseMax(0);
  }
  constexpr double kSeen = 1;  // standard deviations above 0
  if (!(variance(1) > kSeen * std::sqrt(inverse(1, 1)))) return;
  const double spread = std::sqrt(variance(1) / touches);
  const double std = spread * std::sqrt(inverse(1, 1)) / variance(1) / 2;
  const auto delay = std::find_if(result.parameters.begin(), result.parameters.end(),
                                  [](const Calibrated& c) { return c.name == "delay"; });
  result.parameters.insert(delay + 1, {"delay_spread", "ms", spread * 1e3, std * 1e3});
}

// ---- gauge block: both faces in turn

ProbeCalibration calibrate_block(TouchTable& table, const CalibrationSetup& setup) {
  const VectorXd feed = table.need({"feed", "F"}, "feed along the approach");
  const VectorXd upper = table.need({"upper", "up", "mean_up", "mean_upper"}, "position at the upper face");
  const VectorXd lower = table.need({"lower", "lp", "mean_lp", "mean_lower"}, "position at the lower face");
  if (!setup.ball_radius_mm)
    throw text::InputError(
        "the calibration on a block requires the nominal radius of the stylus ball (--ball-radius)");
  const VectorXd difference = (upper - lower).array() - (setup.size_mm + 2 * *setup.ball_radius_mm);
  ProbeCalibration result;
  result.delay_found = varies(feed);
  // d = intercept - 2 F / 60 * delay: both faces are recorded late.
  const TouchModel model = [&](const VectorXd& p) -> VectorXd {
    VectorXd r = difference.array() - p(0);
    if (result.delay_found) r += 2 / maths::kSecondsPerMinute * p(1) * feed;
    return r;
  };
  TouchFitOptions options;
  options.outlier_level = setup.outlier_level;
  result.fit =
      fit_touches(model, VectorXd::Zero(result.delay_found ? 2 : 1), options, {"tip radius", "delay"});
  if (result.delay_found) {
    add(result, "delay", "ms", 1e3, 1);
    const double slope = -2 / maths::kSecondsPerMinute * maths::kUmPerMm;
    result.line_slope_um_per_mm_min = slope * result.fit.value(1);
    result.line_slope_std = std::abs(slope) * result.fit.std_of(1);
    result.line_intercept_um = result.fit.value(0) * maths::kUmPerMm;
    result.line_intercept_std_um = result.fit.std_of(0) * maths::kUmPerMm;
  }
  add(result, "effective_tip_radius", "mm", 0.5, 0, *setup.ball_radius_mm);
  add(result, "pretravel", "um", -0.5 * maths::kUmPerMm, 0);
  say_feeds(feed, result.delay_found, result.findings);
  add_spread(result, feed / maths::kSecondsPerMinute, 2);
  result.findings.push_back(
      "Both faces are along one line: the touches do not determine lobes and direction of the pretravel.");
  return result;
}

// ---- ring and sphere: a centre, a radius and the parameters of feed and direction

struct RoundTouches {
  bool sphere = false;
  VectorXd x, y, z, speed, braking;  // mm, mm/s, mm/s^2
  double sign = 1;                   // +1: touched from outside

  Index first_extra() const { return sphere ? 4 : 3; }
  // Distance of a touch from the surface of the parameters: centre, radius, [delay], [lobes].
  VectorXd residual(const VectorXd& p, const LeverReach& reach) const {
    VectorXd r(x.size());
    for (Index i = 0; i < x.size(); ++i) {
      const double dx = x(i) - p(0), dy = y(i) - p(1), dz = sphere ? z(i) - p(2) : 0;
      const double across = std::hypot(dx, dy), distance = std::hypot(across, dz);
      double late = 0;
      Index next = first_extra();
      if (reach.delay) {
        const double delay = p(next++);
        late += speed(i) * delay - braking(i) * delay * delay / 2;
      }
      if (reach.lobes && across > 0) {
        const double phi = 3 * std::atan2(dy, dx);
        late += across / distance * (p(next) * std::cos(phi) + p(next + 1) * std::sin(phi));
      }
      r(i) = distance - p(first_extra() - 1) + sign * late;
    }
    return r;
  }
  VectorXd start() const {
    VectorXd p(first_extra());
    p(0) = (x.maxCoeff() + x.minCoeff()) / 2, p(1) = (y.maxCoeff() + y.minCoeff()) / 2;
    if (sphere) p(2) = (z.maxCoeff() + z.minCoeff()) / 2;
    const Index d = first_extra() - 1;
    Eigen::MatrixXd m(x.size(), d);
    m.col(0) = x.array() - p(0), m.col(1) = y.array() - p(1);
    if (sphere) m.col(2) = z.array() - p(2);
    const VectorXd s = algebraic_centre(m);
    p.head(d) += s.head(d);
    p(d) = s(d);
    return p;
  }
  // Largest gap between the azimuths of neighbouring touches, deg.
  double largest_gap(const VectorXd& p) const {
    std::vector<double> phi;
    for (Index i = 0; i < x.size(); ++i)
      phi.push_back(std::atan2(y(i) - p(1), x(i) - p(0)) * maths::kDegPerRad);
    std::sort(phi.begin(), phi.end());
    double gap = phi.front() + 360 - phi.back();
    for (std::size_t i = 1; i < phi.size(); ++i) gap = std::max(gap, phi[i] - phi[i - 1]);
    return gap;
  }
};

RoundTouches round_touches(TouchTable& table, const CalibrationSetup& setup) {
  RoundTouches touches;
  touches.sign = setup.artefact == CalibrationArtefact::kRing ? -1 : 1;
  touches.x = table.need({"x", "X"}, "recorded position");
  const auto y = table.find({"y", "Y"}), z = table.find({"z", "Z"});
  const auto stays = [&](const VectorXd& values) {
    constexpr double kPlane = 0.01;  // of the diameter
    return values.maxCoeff() - values.minCoeff() < kPlane * setup.size_mm;
  };
  // A machine of two axes, including X and Z of a lathe, touches a sphere in a plane.
  touches.sphere = setup.artefact == CalibrationArtefact::kSphere && y && z && !stays(*y) && !stays(*z);
  const bool in_xz = setup.artefact == CalibrationArtefact::kSphere && z && (!y || stays(*y));
  touches.y = in_xz ? *z : y ? *y : table.need({"y", "Y"}, "recorded position");
  if (touches.sphere) touches.z = *z;
  touches.speed = table.need({"feed", "F"}, "feed along the approach") / maths::kSecondsPerMinute;
  touches.braking = VectorXd::Zero(touches.x.size());
  if (const auto a = table.find({"a", "acceleration"})) touches.braking = *a;
  return touches;
}

void say_plane(const RoundTouches& touches, const CalibrationSetup& setup,
               std::vector<std::string>& findings) {
  if (setup.artefact != CalibrationArtefact::kSphere || touches.sphere) return;
  constexpr double kOff_mm = 0.5;  // accuracy of placing a sphere by hand
  findings.push_back(fmt::format(
      "The sphere was touched in one plane. The result assumes that this plane goes through the centre: a "
      "plane {} mm beside the centre makes the effective tip radius {:.1f} um too small.",
      kOff_mm, kOff_mm * kOff_mm / setup.size_mm * maths::kUmPerMm));
}

void say_round(const RoundTouches& touches, const LeverReach& reach, double gap,
               std::vector<std::string>& findings) {
  say_feeds(touches.speed * maths::kSecondsPerMinute, reach.delay, findings);
  if (!reach.lobes && gap > kLargestGapDeg)
    findings.push_back(
        fmt::format("There is no touch in {:.0f} deg of the azimuth: a three-lobed pretravel cannot be "
                    "distinguished from an eccentric centre. Touch all round, every 30 deg or closer.",
                    gap));
  if (touches.braking.cwiseAbs().maxCoeff() == 0)
    findings.push_back(
        "The evaluation assumes a constant feed at every touch; if an approach is too short for a constant "
        "feed, record a[mm/s^2].");
}

ProbeCalibration calibrate_round(TouchTable& table, const CalibrationSetup& setup) {
  const RoundTouches touches = round_touches(table, setup);
  TouchFitOptions options;
  options.outlier_level = setup.outlier_level;
  options.u = table.uncertainty();
  const std::vector<std::string> names =
      touches.sphere ? std::vector<std::string>{"centre x", "centre y",    "centre z", "tip radius",
                                                "delay",    "lobe cosine", "lobe sine"}
                     : std::vector<std::string>{"centre x", "centre y",    "tip radius",
                                                "delay",    "lobe cosine", "lobe sine"};
  const VectorXd start = touches.start();
  const double gap = touches.largest_gap(start);
  const auto fit_with = [&](const LeverReach& reach, const TouchFitOptions& how) {
    VectorXd from = VectorXd::Zero(start.size() + (reach.delay ? 1 : 0) + (reach.lobes ? 2 : 0));
    from.head(start.size()) = start;
    std::vector<std::string> used(names.begin(), names.begin() + start.size());
    if (reach.delay) used.emplace_back("delay");
    if (reach.lobes) used.insert(used.end(), {"lobe cosine", "lobe sine"});
    return fit_touches([&, reach](const VectorXd& p) { return touches.residual(p, reach); }, from, how, used);
  };
  LeverReach reach{varies(touches.speed), false};
  ProbeCalibration result;
  const bool may_have_lobes = gap <= kLargestGapDeg && touches.x.size() >= start.size() + 6;
  reach.lobes = may_have_lobes;
  result.fit = fit_with(reach, options);
  if (may_have_lobes) {
    TouchFitOptions same = options;
    same.outlier_level = 0;
    // Compared over the same touches: all of them.
    if (result.fit.outliers.empty() &&
        !explains(result.fit, fit_with({reach.delay, false}, same), kLobeChance)) {
      reach.lobes = false;
      result.findings.push_back(
          "A pretravel with three lobes is not detected, although the touches are sufficient to detect it: "
          "the lobes are smaller than the scatter of the touches.");
      result.fit = fit_with(reach, options);
    }
  }
  result.delay_found = reach.delay, result.lobes_found = reach.lobes;
  const Index extra = touches.first_extra();
  if (reach.delay) add(result, "delay", "ms", 1e3, extra);
  const double half = setup.size_mm / 2;
  // Outside: distance = half + tip; inside: half - tip.
  add(result, "effective_tip_radius", "mm", touches.sign, extra - 1, -touches.sign * half);
  if (setup.ball_radius_mm) {
    const Calibrated& tip = result.parameters.back();
    result.parameters.push_back({"pretravel", "um", (*setup.ball_radius_mm - tip.value) * maths::kUmPerMm,
                                 tip.std * maths::kUmPerMm});
  }
  if (reach.lobes) {
    const Index c = extra + (reach.delay ? 1 : 0);
    const double cosine = result.fit.value(c), sine = result.fit.value(c + 1),
                 size = std::hypot(cosine, sine);
    Eigen::Vector2d along(cosine / size, sine / size), across(-sine / size, cosine / size);
    const Eigen::Matrix2d v = result.fit.covariance.block<2, 2>(c, c);
    result.parameters.push_back(
        {"lobe", "um", size * maths::kUmPerMm, std::sqrt(along.dot(v * along)) * maths::kUmPerMm});
    result.parameters.push_back({"lobe_azimuth", "deg", std::atan2(sine, cosine) * maths::kDegPerRad / 3,
                                 std::sqrt(across.dot(v * across)) / size * maths::kDegPerRad / 3});
  }
  const char* const axes[] = {"centre_x", "centre_y", "centre_z"};
  for (Index i = 0; i < extra - 1; ++i) add(result, axes[i], "mm", 1, i);
  say_round(touches, reach, gap, result.findings);
  say_plane(touches, setup, result.findings);
  add_spread(result, touches.speed, 1);
  return result;
}

}  // namespace

const Calibrated* find_calibrated(const std::vector<Calibrated>& parameters, const std::string& name) {
  const auto found =
      std::find_if(parameters.begin(), parameters.end(), [&](const Calibrated& c) { return c.name == name; });
  return found == parameters.end() ? nullptr : &*found;
}

void say_outliers(const TouchFit& fit, const TouchTable& table, std::vector<std::string>& findings) {
  for (const TouchOutlier& outlier : fit.outliers)
    findings.push_back(
        fmt::format("{}:{}: excluded as an outlier: {:+.2f} um from the other touches, {:.0f} times their "
                    "scatter (probability {:.1g})",
                    table.file(), table.line(outlier.touch), outlier.residual * maths::kUmPerMm,
                    std::abs(outlier.t), outlier.p_value));
}

namespace {

// A value that no probe has is caused by a column in another unit, by wrong rows or by another
// artefact.
void refuse_absurd(const ProbeCalibration& result, const CalibrationSetup& setup, const TouchTable& table) {
  // Largest possible delay of a trigger; negative only by rounding.
  constexpr double kLeastDelay_ms = -1, kMostDelay_ms = 100;
  const char* const kHint =
      "check units and columns (--column \"name=meaning[unit]\"), --size and --artefact";
  if (const Calibrated* const delay = result.find("delay");
      delay &&
      (delay->value - 3 * delay->std > kMostDelay_ms || delay->value + 3 * delay->std < kLeastDelay_ms))
    throw text::InputError(
        fmt::format("{}: the touches give a delay of {:.4g} ms, which is impossible for a probe: {}",
                    table.file(), delay->value, kHint));
  const Calibrated* const tip = result.find("effective_tip_radius");
  if (tip && std::abs(tip->value) - 3 * tip->std > setup.size_mm)
    throw text::InputError(
        fmt::format("{}: the touches give an effective tip radius of {:.4g} mm, which is larger than the "
                    "artefact of {:.4g} mm: {}",
                    table.file(), tip->value, setup.size_mm, kHint));
}

// Conditions of the touches, if they are given.
void say_conditions(TouchTable& table, const CalibrationSetup& setup, std::vector<std::string>& findings) {
  if (!setup.clearance_mm && !setup.overtravel_mm) return;
  const VectorXd feed = table.need({"feed", "F"}, "feed along the approach");
  std::vector<double> feeds(feed.begin(), feed.end());
  std::sort(feeds.begin(), feeds.end());
  feeds.erase(std::unique(feeds.begin(), feeds.end()), feeds.end());
  for (const double one : feeds)
    for (const std::string& reason :
         broken_conditions(setup.conditions, one, setup.clearance_mm.value_or(1e9), setup.overtravel_mm))
      findings.push_back("Not valid touches: " + reason + ".");
}

}  // namespace

ProbeCalibration calibrate_probe(TouchTable& table, const CalibrationSetup& setup) {
  if (!(setup.size_mm > 0)) throw text::InputError("the size of the artefact is not above 0 (--size)");
  ProbeCalibration result = setup.artefact == CalibrationArtefact::kBlock ? calibrate_block(table, setup)
                                                                          : calibrate_round(table, setup);
  refuse_absurd(result, setup, table);
  say_conditions(table, setup, result.findings);
  say_outliers(result.fit, table, result.findings);
  for (const std::string& note : table.notes()) result.findings.push_back(note);
  return result;
}

GroupComparison compare_groups(const TouchTable& table, const CalibrationSetup& setup,
                               const std::string& column, const ProbeCalibration& all) {
  const std::vector<std::string> values = table.values_of(column);
  if (values.size() < 2)
    throw text::InputError({table.file(), table.csv().header_line}, column, "one group only");
  GroupComparison result;
  double within = 0;
  int dof = 0;
  for (const std::string& value : values) {
    TouchTable part = table.only(column, value);
    const ProbeCalibration one = calibrate_probe(part, setup);
    result.groups.push_back({value, part.rows(), one.parameters});
    within += one.fit.sigma * one.fit.sigma * one.fit.dof;
    dof += one.fit.dof;
  }
  const double together = all.fit.sigma * all.fit.sigma * all.fit.dof;
  const int extra = all.fit.dof - dof;
  if (extra > 0 && dof > 0 && within > 0)
    result.chance =
        std::exp(maths::log_f_tail(std::max(0.0, together - within) / extra / (within / dof), extra, dof));
  result.words = result.chance < kGroupChance
                     ? fmt::format(
                           "The groups differ significantly (probability {:.1g} for equal groups): calibrate "
                           "each group separately.",
                           result.chance)
                     : fmt::format("The groups do not differ by more than their scatter (chance {:.2g}).",
                                   result.chance);
  return result;
}

}  // namespace vernier::probe
