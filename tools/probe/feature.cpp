// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/probe/feature.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "tools/format/columns.h"
#include "tools/maths/factors.h"
#include "tools/text/error.h"

namespace vernier::probe {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Touches in their own frame: origin at their centroid, third axis along the normal or axis.
struct Touches {
  MatrixXd p;  // n x 3, centres of the ball
  std::optional<MatrixXd> n;
  std::optional<VectorXd> u;

  Index size() const { return p.rows(); }
  Vector3d centroid() const { return p.colwise().mean().transpose(); }
  // Principal directions, greatest scatter first; right-handed.
  Matrix3d principal() const {
    const MatrixXd c = p.rowwise() - p.colwise().mean();
    const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(Matrix3d(c.transpose() * c));
    Matrix3d v = eigen.eigenvectors().rowwise().reverse();
    if (v.determinant() < 0) v.col(2) *= -1;
    return v;
  }
};

Touches read_touches(TouchTable& table, const FeatureSetup& setup, std::vector<std::string>& findings) {
  Touches touches;
  const auto rows = static_cast<Index>(table.rows());
  touches.p.resize(rows, 3);
  touches.p.col(0) = table.need({"x", "X"}, "recorded point");
  touches.p.col(1) = table.need({"y", "Y"}, "recorded point");
  const bool flat = setup.kind == FeatureKind::kLine || setup.kind == FeatureKind::kCircle ||
                    setup.kind == FeatureKind::kBlock;
  const auto z = table.find({"z", "Z"});
  if (!z && !flat) table.need({"z"}, "recorded point");
  touches.p.col(2) = z ? *z : VectorXd::Zero(rows);
  if (const auto nx = table.find({format::columns::kNormal[0]})) {
    MatrixXd n(rows, 3);
    n.col(0) = *nx;
    n.col(1) = table.need({format::columns::kNormal[1]}, "normal");
    const auto nz = table.find({format::columns::kNormal[2]});
    n.col(2) = nz ? *nz : VectorXd::Zero(rows);
    for (Index i = 0; i < rows; ++i) {
      const double length = n.row(i).norm();
      if (std::abs(length - 1) > 1e-3)
        throw text::InputError({table.file(), table.line(static_cast<std::size_t>(i))},
                               fmt::format("{:.4g}", length), "the length of the normal is not 1");
      n.row(i) /= length;
    }
    touches.n = n;
  }
  touches.u = table.uncertainty();
  if (!setup.expansion_per_K) return touches;
  auto t = table.find({"T"});
  if (!t && setup.temperature_degC) t = VectorXd::Constant(rows, *setup.temperature_degC);
  if (!t)
    throw text::InputError(fmt::format(
        "{}: the expansion needs a temperature (column T[degC], or --temperature)", table.file()));
  for (Index i = 0; i < rows; ++i)
    touches.p.row(i) /= 1 + *setup.expansion_per_K * ((*t)(i)-maths::kReferenceDegC);
  findings.push_back(
      fmt::format("Points as at 20 degC: measured at {:.2f} degC in the mean, expansion {:.3g} um/(m K), "
                  "about the origin.",
                  t->mean(), *setup.expansion_per_K * 1e6));
  return touches;
}

TouchFitOptions options_of(const Touches& touches, const FeatureSetup& setup, std::size_t per_touch = 1) {
  TouchFitOptions options;
  options.per_touch = per_touch;
  options.outlier_level = setup.outlier_level;
  if (touches.u) {
    VectorXd u(touches.size() * static_cast<Index>(per_touch));
    for (Index i = 0; i < u.size(); ++i) u(i) = (*touches.u)(i / static_cast<Index>(per_touch));
    options.u = u;
  }
  return options;
}

/// A feature during the computation: parameters as functions of those of the fit, with propagated
/// uncertainty.
struct Maker {
  MeasuredFeature& feature;
  void add(const std::string& name, const std::string& unit,
           const std::function<double(const VectorXd&)>& of) const {
    const TouchFit& fit = feature.fit;
    VectorXd gradient(fit.value.size());
    for (Index k = 0; k < gradient.size(); ++k) {
      const double h = 1e-6 * std::max(1.0, std::abs(fit.value(k)));
      VectorXd up = fit.value, down = fit.value;
      up(k) += h, down(k) -= h;
      gradient(k) = (of(up) - of(down)) / (2 * h);
    }
    feature.parameters.push_back(
        {name, unit, of(fit.value), std::sqrt(std::max(0.0, gradient.dot(fit.covariance * gradient)))});
  }
  void add_vector(const std::string& name, const std::string& unit,
                  const std::function<Vector3d(const VectorXd&)>& of) const {
    const char* const axes[] = {"_x", "_y", "_z"};
    for (int k = 0; k < 3; ++k) add(name + axes[k], unit, [&of, k](const VectorXd& p) { return of(p)(k); });
  }
};

/// Returns the side on which the ball's centres are: +1 outside, -1 inside, by the normals if
/// there are any.
double side_of(const Touches& touches, const FeatureSetup& setup,
               const std::function<Vector3d(Index)>& outward) {
  if (!touches.n) return setup.inside ? -1 : 1;
  double sum = 0;
  for (Index i = 0; i < touches.size(); ++i) sum += touches.n->row(i).dot(outward(i));
  return sum < 0 ? -1 : 1;
}

// ---- plane and line

MeasuredFeature fit_plane(const Touches& touches, const FeatureSetup& setup) {
  MeasuredFeature feature;
  const Vector3d c = touches.centroid();
  Matrix3d v = touches.principal();
  if (touches.n ? touches.n->colwise().sum().dot(v.col(2)) < 0 : v(2, 2) < 0) v.col(2) *= -1, v.col(0) *= -1;
  const MatrixXd local = (touches.p.rowwise() - c.transpose()) * v;
  const double lift = touches.n ? setup.ball_radius_mm : 0;
  const TouchModel model = [&](const VectorXd& p) -> VectorXd {
    const double scale = 1 / std::sqrt(1 + p(1) * p(1) + p(2) * p(2));
    return scale *
           (local.col(2).array() - p(0) - p(1) * local.col(0).array() - p(2) * local.col(1).array()).matrix();
  };
  feature.fit = fit_touches(model, Vector3d::Zero(), options_of(touches, setup), {"height", "tilt", "tilt"});
  const auto normal = [v](const VectorXd& p) -> Vector3d {
    return (v * Vector3d(-p(1), -p(2), 1)).normalized();
  };
  const Maker make{feature};
  make.add_vector("point", "mm", [&](const VectorXd& p) -> Vector3d {
    const Vector3d n = normal(p);
    return c + (n.dot(v * Vector3d(0, 0, p(0))) - lift) * n;
  });
  make.add_vector("normal", "", normal);
  make.add("tilt_x", "deg",
           [&](const VectorXd& p) { return std::atan2(-normal(p)(1), normal(p)(2)) * maths::kDegPerRad; });
  make.add("tilt_y", "deg",
           [&](const VectorXd& p) { return std::atan2(normal(p)(0), normal(p)(2)) * maths::kDegPerRad; });
  feature.normals = normal(feature.fit.value).transpose().replicate(touches.size(), 1);
  feature.deviation = feature.fit.residual;
  if (!touches.n && setup.ball_radius_mm > 0)
    feature.findings.push_back(
        "The file has no normals (nx ny nz): the result is the plane through the centres of the stylus ball, "
        "and the radius of the ball is not subtracted.");
  return feature;
}

MeasuredFeature fit_line(const Touches& touches, const FeatureSetup& setup) {
  MeasuredFeature feature;
  const Vector3d c = touches.centroid();
  Matrix3d v = touches.principal();
  const bool flat = (touches.p.col(2).array() - c(2)).abs().maxCoeff() < 1e-9;
  if (flat) {
    // In the plane z = const the line has one offset and one angle.
    v.col(2) = Vector3d::UnitZ();
    v.col(1) = v.col(2).cross(v.col(0));
  }
  Index main = 0;
  v.col(0).cwiseAbs().maxCoeff(&main);
  if (v(main, 0) < 0) v.col(0) *= -1, v.col(1) *= -1;
  const Index across = flat ? 1 : 2;
  const MatrixXd local = (touches.p.rowwise() - c.transpose()) * v;
  const TouchModel model = [&](const VectorXd& p) -> VectorXd {
    VectorXd r(across * local.rows());
    for (Index i = 0; i < local.rows(); ++i) {
      const Vector3d along = Vector3d(1, p(across), flat ? 0 : p(3)).normalized();
      const Vector3d from = local.row(i).transpose() - Vector3d(0, p(0), flat ? 0 : p(1));
      const Vector3d off = from - along * along.dot(from);
      for (Index k = 0; k < across; ++k) r(across * i + k) = off(k + 1);
    }
    return r;
  };
  feature.fit = fit_touches(model, VectorXd::Zero(2 * across),
                            options_of(touches, setup, static_cast<std::size_t>(across)),
                            flat ? std::vector<std::string>{"offset", "angle"}
                                 : std::vector<std::string>{"offset", "offset", "angle", "angle"});
  const auto direction = [v, across, flat](const VectorXd& p) -> Vector3d {
    return (v * Vector3d(1, p(across), flat ? 0 : p(3))).normalized();
  };
  // Towards the material: the ball's centres minus its radius, if normals give the side.
  Vector3d off = Vector3d::Zero();
  if (touches.n) {
    const Vector3d mean = touches.n->colwise().mean().transpose(), d = direction(feature.fit.value);
    off = (mean - d * d.dot(mean)).normalized() * setup.ball_radius_mm;
  }
  const Maker make{feature};
  make.add_vector("point", "mm", [&](const VectorXd& p) -> Vector3d {
    return c + v * Vector3d(0, p(0), flat ? 0 : p(1)) - off;
  });
  make.add_vector("direction", "", direction);
  make.add("angle", "deg", [&](const VectorXd& p) {
    return std::atan2(direction(p)(1), direction(p)(0)) * maths::kDegPerRad;
  });
  feature.normals = MatrixXd::Zero(touches.size(), 3);
  feature.deviation = VectorXd::Zero(touches.size());
  for (Index i = 0; i < touches.size(); ++i) {
    const Vector3d n = touches.n ? Vector3d(touches.n->row(i)) : Vector3d(v.col(1));
    feature.normals.row(i) = n.transpose();
    for (Index k = 0; k < across; ++k)
      feature.deviation(i) += n.dot(v.col(k + 1)) * feature.fit.residual(across * i + k);
  }
  if (!touches.n && setup.ball_radius_mm > 0)
    feature.findings.push_back(
        "The file has no normals (nx ny nz): the result is the line through the centres of the stylus ball, "
        "and the radius of the ball is not subtracted.");
  return feature;
}

// ---- circle, sphere, cylinder

void add_radius(const Maker& make, const FeatureSetup& setup, double side, Index at) {
  make.add("radius", "mm", [=](const VectorXd& p) { return p(at) - side * setup.ball_radius_mm; });
}

MeasuredFeature fit_circle(const Touches& touches, const FeatureSetup& setup) {
  MeasuredFeature feature;
  const Vector3d c = touches.centroid();
  Matrix3d v = touches.principal();
  const bool flat = (touches.p.col(2).array() - c(2)).abs().maxCoeff() < 1e-9;
  if (flat) v = Matrix3d::Identity();
  if (v(2, 2) < 0) v.col(2) *= -1, v.col(0) *= -1;
  const MatrixXd local = (touches.p.rowwise() - c.transpose()) * v;
  const TouchModel model = [&](const VectorXd& p) -> VectorXd {
    return ((local.col(0).array() - p(0)).square() + (local.col(1).array() - p(1)).square()).sqrt() - p(2);
  };
  feature.fit = fit_touches(model, algebraic_centre(local.leftCols(2)), options_of(touches, setup),
                            {"centre", "centre", "radius"});
  const VectorXd& f = feature.fit.value;
  const auto outward = [&](Index i) -> Vector3d {
    return (v * Vector3d(local(i, 0) - f(0), local(i, 1) - f(1), 0)).normalized();
  };
  const double side = side_of(touches, setup, outward);
  const Maker make{feature};
  make.add_vector("centre", "mm",
                  [&](const VectorXd& p) -> Vector3d { return c + v * Vector3d(p(0), p(1), 0); });
  if (!flat) make.add_vector("normal", "", [&](const VectorXd&) -> Vector3d { return v.col(2); });
  add_radius(make, setup, side, 2);
  feature.normals.resize(touches.size(), 3);
  for (Index i = 0; i < touches.size(); ++i) feature.normals.row(i) = side * outward(i).transpose();
  feature.deviation = side * feature.fit.residual;
  if (!flat)
    feature.findings.push_back(
        fmt::format("The circle is in the best-fit plane of the touches; the largest distance of a touch "
                    "from this plane is {:.2f} um.",
                    local.col(2).cwiseAbs().maxCoeff() * 1e3));
  return feature;
}

MeasuredFeature fit_sphere(const Touches& touches, const FeatureSetup& setup) {
  MeasuredFeature feature;
  const Vector3d c = touches.centroid();
  const MatrixXd local = touches.p.rowwise() - c.transpose();
  const TouchModel model = [&](const VectorXd& p) -> VectorXd {
    return (local.rowwise() - p.head(3).transpose()).rowwise().norm().array() - p(3);
  };
  feature.fit = fit_touches(model, algebraic_centre(local), options_of(touches, setup),
                            {"centre x", "centre y", "centre z", "radius"});
  const VectorXd& f = feature.fit.value;
  const auto outward = [&](Index i) -> Vector3d {
    return (local.row(i).transpose() - f.head(3)).normalized();
  };
  const double side = side_of(touches, setup, outward);
  const Maker make{feature};
  make.add_vector("centre", "mm", [&](const VectorXd& p) -> Vector3d { return c + p.head(3); });
  add_radius(make, setup, side, 3);
  feature.normals.resize(touches.size(), 3);
  for (Index i = 0; i < touches.size(); ++i) feature.normals.row(i) = side * outward(i).transpose();
  feature.deviation = side * feature.fit.residual;
  return feature;
}

// Frame whose third column is the given direction.
Matrix3d frame_along(const Vector3d& axis) {
  Index least = 0;
  axis.cwiseAbs().minCoeff(&least);
  Matrix3d v;
  v.col(2) = axis.normalized();
  v.col(0) = v.col(2).cross(Vector3d::Unit(least)).normalized();
  v.col(1) = v.col(2).cross(v.col(0));
  return v;
}

struct CylinderModel {
  MatrixXd local;  // touches in the frame of a first axis
  // p: x, y of the axis at the centroid, its slopes, radius.
  VectorXd operator()(const VectorXd& p) const {
    const Vector3d axis = Vector3d(p(2), p(3), 1).normalized(), at(p(0), p(1), 0);
    VectorXd r(local.rows());
    for (Index i = 0; i < local.rows(); ++i) r(i) = axis.cross(Vector3d(local.row(i)) - at).norm() - p(4);
    return r;
  }
};

MeasuredFeature fit_cylinder(const Touches& touches, const FeatureSetup& setup) {
  const Vector3d c = touches.centroid();
  const MatrixXd off = touches.p.rowwise() - c.transpose();
  // Normals give the axis. Otherwise the principal directions and those of the machine are tried.
  std::vector<Vector3d> tries;
  if (touches.n) {
    Eigen::SelfAdjointEigenSolver<Matrix3d> e(touches.n->transpose() * *touches.n);
    tries.push_back(e.eigenvectors().col(0));
  } else {
    const Matrix3d v = touches.principal();
    for (int k = 0; k < 3; ++k) tries.push_back(v.col(k)), tries.push_back(Vector3d::Unit(k));
  }
  std::optional<MeasuredFeature> best;
  Matrix3d frame;
  std::string why;
  for (const Vector3d& axis : tries) {
    const Matrix3d v = frame_along(axis);
    const CylinderModel model{off * v};
    VectorXd start = VectorXd::Zero(5);
    const VectorXd circle = algebraic_centre(model.local.leftCols(2));
    start(0) = circle(0), start(1) = circle(1), start(4) = circle(2);
    try {
      MeasuredFeature feature;
      feature.fit = fit_touches(model, start, options_of(touches, setup),
                                {"axis x", "axis y", "tilt x", "tilt y", "radius"});
      if (!best || feature.fit.outliers.size() < best->fit.outliers.size() ||
          (feature.fit.outliers.size() == best->fit.outliers.size() && feature.fit.rms < best->fit.rms))
        best = feature, frame = v;
    } catch (const text::InputError& error) {
      why = error.what();
    }
  }
  if (!best) throw text::InputError(why);
  MeasuredFeature& feature = *best;
  const auto axis = [&](const VectorXd& p) -> Vector3d {
    const Vector3d a = (frame * Vector3d(p(2), p(3), 1)).normalized();
    Index main = 0;
    a.cwiseAbs().maxCoeff(&main);
    return a(main) < 0 ? Vector3d(-a) : a;
  };
  const auto outward = [&](Index i) -> Vector3d {
    const Vector3d a = axis(feature.fit.value),
                   at = frame * Vector3d(feature.fit.value(0), feature.fit.value(1), 0);
    const Vector3d from = Vector3d(off.row(i)) - at;
    return (from - a * a.dot(from)).normalized();
  };
  const double side = side_of(touches, setup, outward);
  const Maker make{feature};
  make.add_vector("centre", "mm", [&](const VectorXd& p) -> Vector3d {
    const Vector3d a = axis(p), at = frame * Vector3d(p(0), p(1), 0);
    return c + at - a * a.dot(at);
  });
  make.add_vector("axis", "", axis);
  add_radius(make, setup, side, 4);
  feature.normals.resize(touches.size(), 3);
  for (Index i = 0; i < touches.size(); ++i) feature.normals.row(i) = side * outward(i).transpose();
  feature.deviation = side * feature.fit.residual;
  return feature;
}

// ---- block

struct BlockModel {
  const Touches& touches;
  std::vector<int> axis;     // face across X (0) or Y (1)
  std::vector<double> side;  // +1, -1
  // p: angle of the block, position of its centre along its own X and Y.
  std::array<double, 2> half;
  double ball;
  VectorXd operator()(const VectorXd& p) const {
    const Eigen::Vector2d x(std::cos(p(0)), std::sin(p(0))), y(-x(1), x(0));
    VectorXd r(touches.size());
    for (Index i = 0; i < touches.size(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      const Eigen::Vector2d m = touches.p.row(i).head(2).transpose();
      const double along = axis[k] == 0 ? m.dot(x) - p(1) : m.dot(y) - p(2);
      r(i) = along - side[k] * (half[static_cast<std::size_t>(axis[k])] + ball);
    }
    return r;
  }
};

MeasuredFeature fit_block(const Touches& touches, const FeatureSetup& setup) {
  if (!touches.n)
    throw text::InputError(
        "the rows of a gauge block must have the normal of the touched face (columns nx, ny)");
  if (!(setup.block_size_mm[0] > 0 && setup.block_size_mm[1] > 0))
    throw text::InputError(
        "the size of the gauge block is missing: give its lengths along X and Y in mm (--size X,Y)");
  BlockModel model{
      touches, {}, {}, {setup.block_size_mm[0] / 2, setup.block_size_mm[1] / 2}, setup.ball_radius_mm};
  std::set<int> faces;
  for (Index i = 0; i < touches.size(); ++i) {
    const double nx = (*touches.n)(i, 0), ny = (*touches.n)(i, 1);
    if (std::max(std::abs(nx), std::abs(ny)) < 0.9)
      throw text::InputError(
          "a normal of the block lies along neither X nor Y (the block is turned by more than 25 deg)");
    model.axis.push_back(std::abs(nx) > std::abs(ny) ? 0 : 1);
    model.side.push_back(model.axis.back() == 0 ? (nx > 0 ? 1 : -1) : (ny > 0 ? 1 : -1));
    faces.insert(model.axis.back());
  }
  if (faces.size() < 2) throw text::InputError("both a face across X and a face across Y must be touched");
  MeasuredFeature feature;
  Vector3d start(0, touches.p.col(0).mean(), touches.p.col(1).mean());
  feature.fit = fit_touches(model, start, options_of(touches, setup), {"angle", "centre x", "centre y"});
  const Maker make{feature};
  const auto centre = [](const VectorXd& p) -> Vector3d {
    return {p(1) * std::cos(p(0)) - p(2) * std::sin(p(0)), p(1) * std::sin(p(0)) + p(2) * std::cos(p(0)), 0};
  };
  make.add("centre_x", "mm", [&](const VectorXd& p) { return centre(p)(0); });
  make.add("centre_y", "mm", [&](const VectorXd& p) { return centre(p)(1); });
  make.add("angle", "deg", [](const VectorXd& p) { return p(0) * maths::kDegPerRad; });
  feature.normals = MatrixXd::Zero(touches.size(), 3);
  feature.deviation.resize(touches.size());
  const double a = feature.fit.value(0);
  for (Index i = 0; i < touches.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Vector3d n =
        model.axis[k] == 0 ? Vector3d(std::cos(a), std::sin(a), 0) : Vector3d(-std::sin(a), std::cos(a), 0);
    feature.normals.row(i) = model.side[k] * n.transpose();
    feature.deviation(i) = model.side[k] * feature.fit.residual(i);
  }
  return feature;
}

MeasuredFeature fit_kind(const Touches& touches, const FeatureSetup& setup) {
  switch (setup.kind) {
    case FeatureKind::kPlane:
      return fit_plane(touches, setup);
    case FeatureKind::kLine:
      return fit_line(touches, setup);
    case FeatureKind::kCircle:
      return fit_circle(touches, setup);
    case FeatureKind::kSphere:
      return fit_sphere(touches, setup);
    case FeatureKind::kCylinder:
      return fit_cylinder(touches, setup);
    case FeatureKind::kBlock:
      return fit_block(touches, setup);
  }
  throw text::InputError("this kind of feature is unknown");
}

// Expansion and temperature are the same for all touches. They increase the uncertainty of sizes
// and positions.
void widen(MeasuredFeature& feature, const FeatureSetup& setup, double off_reference_K) {
  const double relative = std::hypot(setup.expansion_std_per_K * off_reference_K,
                                     *setup.expansion_per_K * setup.temperature_std_K);
  for (Calibrated& p : feature.parameters)
    if (p.unit == "mm") p.std = std::hypot(p.std, relative * p.value);
}

}  // namespace

MeasuredFeature fit_feature(TouchTable& table, const FeatureSetup& setup) {
  std::vector<std::string> findings;
  const Touches touches = read_touches(table, setup, findings);
  MeasuredFeature feature = fit_kind(touches, setup);
  feature.points = touches.p;
  if (setup.expansion_per_K) {
    const auto t = table.find({"T"});
    widen(feature, setup, (t ? t->mean() : *setup.temperature_degC) - maths::kReferenceDegC);
  }
  double low = 0, high = 0;
  for (Index i = 0; i < feature.deviation.size(); ++i)
    if (feature.fit.kept[static_cast<std::size_t>(i)])
      low = std::min(low, feature.deviation(i)), high = std::max(high, feature.deviation(i));
  feature.form_mm = high - low;
  if (feature.fit.dof == 0)
    feature.findings.push_back(
        "The number of touches equals the number of unknowns: the feature passes through all touches, and "
        "the residuals are 0.");
  say_outliers(feature.fit, table, feature.findings);
  feature.findings.insert(feature.findings.begin(), findings.begin(), findings.end());
  feature.findings.insert(feature.findings.end(), table.notes().begin(), table.notes().end());
  return feature;
}

std::string feature_csv(const TouchTable& table, const MeasuredFeature& feature) {
  // The columns of a deviation replace the recorded point.
  std::set<std::string> replaced;
  std::string headings;
  const auto take = [&](const format::ColumnGroup& group, bool written) {
    for (const char* const name : group.list()) {
      replaced.insert(name);
      if (written) headings += (headings.empty() ? "" : ",") + format::heading(name);
    }
  };
  take(format::reading_columns(format::ReadingForm::kPoint), false);
  take(format::reading_columns(format::ReadingForm::kDeviation), true);
  take(*format::find_column(format::columns::kNormal.front()), true);
  take(*format::find_column(format::columns::kNominalPoint.front()), true);
  std::string text;
  auto out = std::back_inserter(text);
  const format::CsvFile& csv = table.csv();
  for (const format::CsvColumn& column : csv.columns)
    if (!replaced.contains(column.name))
      fmt::format_to(out, "{}{},", column.name, column.unit.empty() ? "" : "[" + column.unit + "]");
  text += headings + "\n";
  for (std::size_t i = 0; i < csv.rows.size(); ++i) {
    const auto k = static_cast<Index>(i);
    // An outlier is not an observation of this feature.
    if (!feature.fit.kept[i]) continue;
    for (std::size_t c = 0; c < csv.columns.size(); ++c)
      if (!replaced.contains(csv.columns[c].name)) text += csv.rows[i][c] + ",";
    const Vector3d n = feature.normals.row(k), p = Vector3d(feature.points.row(k)) - feature.deviation(k) * n;
    fmt::format_to(out, "{:.9g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g}\n", feature.deviation(k),
                   n(0), n(1), n(2), p(0), p(1), p(2));
  }
  return text;
}

}  // namespace vernier::probe
