// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/exchange/printer/correction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tools/exchange/variance_of.h"
#include "tools/format/columns.h"
#include "tools/kinematics/correction.h"
#include "tools/maths/decompositions.h"
#include "tools/maths/factors.h"
#include "tools/model/chain/chain.h"
#include "tools/model/fit_record.h"
#include "tools/model/parameters.h"
#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::exchange {
namespace {

using Eigen::Index;
using Eigen::Matrix3Xd;
using Eigen::VectorXd;

/// What has to be added to each command, mm.
Matrix3Xd needed(const model::Machine& machine, const ThreeAxes& axes, const Matrix3Xd& commands,
                 const model::States& at) {
  const kinematics::CorrectionResult result = kinematics::correct(machine, states_at(axes, commands, at));
  Matrix3Xd offset(3, commands.cols());
  for (std::size_t i = 0; i < 3; ++i)
    offset.row(static_cast<Index>(i)) = result.offset[axes.axis[i]].matrix().transpose();
  return offset;
}

Matrix3Xd nominal_points(const model::Machine& machine, const ThreeAxes& axes, const Matrix3Xd& commands,
                         const model::States& at) {
  return model::forward(model::nominal_machine(machine), states_at(axes, commands, at)).position;
}

/// Heights of the bed at points of workpiece coordinates; 0 without a bed.
VectorXd bed_heights(const std::optional<Bed>& bed, const Matrix3Xd& points) {
  VectorXd heights = VectorXd::Zero(points.cols());
  for (Index i = 0; bed && i < points.cols(); ++i) heights[i] = bed->height(points(0, i), points(1, i));
  return heights;
}

/// What has to be added to the command of Z, mm: for the errors of the machine and for the slope of the bed.
VectorXd needed_heights(const model::Machine& machine, const ThreeAxes& axes, const Matrix3Xd& commands,
                        const model::States& at, const std::optional<Bed>& bed) {
  const VectorXd of_machine = needed(machine, axes, commands, at).row(2);
  if (!bed) return of_machine;
  // A bed that moves along Z itself rises where the command of Z falls.
  Matrix3Xd higher = commands;
  higher.row(2).array() += 1;
  const Matrix3Xd points = nominal_points(machine, axes, commands, at);
  const VectorXd rise = (nominal_points(machine, axes, higher, at) - points).row(2);
  return of_machine + bed_heights(bed, points).cwiseQuotient(rise);
}

VectorXd evenly(double low, double high, std::size_t count) {
  return VectorXd::LinSpaced(static_cast<Index>(count), low, high);
}

/// All points of a grid: count positions of each axis.
Matrix3Xd grid(const ThreeAxes& axes, std::array<std::size_t, 3> count) {
  Matrix3Xd points(3, static_cast<Index>(count[0] * count[1] * count[2]));
  const VectorXd x = evenly(axes.low[0], axes.high[0], count[0]),
                 y = evenly(axes.low[1], axes.high[1], count[1]);
  const VectorXd z =
      count[2] == 1 ? VectorXd::Constant(1, axes.low[2]) : evenly(axes.low[2], axes.high[2], count[2]);
  Index at = 0;
  for (const double height : z)
    for (const double across : y)
      for (const double along : x) points.col(at++) = Eigen::Vector3d(along, across, height);
  return points;
}

/// Skew XY, XZ, YZ and the factors of the steps of X, Y, Z less 1.
using StraightParts = Eigen::Matrix<double, 6, 1>;

/// Skew and steps. A part of Y that depends on X and the opposite part of X are one turn about Z: the skew is
/// their sum.
StraightParts straight_parts(const Matrix3Xd& points, const Matrix3Xd& offset) {
  Eigen::MatrixXd columns(points.cols(), 4);
  columns << points.transpose(), VectorXd::Ones(points.cols());
  const VectorXd x = maths::least_squares(columns, offset.row(0).transpose()),
                 y = maths::least_squares(columns, offset.row(1).transpose()),
                 z = maths::least_squares(columns, offset.row(2).transpose());
  return {x[1] + y[0], x[2], y[2], x[0], y[1], z[2]};
}

/// Standard uncertainty of the straight parts: by the parameters that no reading of the last fit determines,
/// or by all parameters. 0 if the last fit is not known.
StraightParts std_of_parts(const model::Machine& machine, const ThreeAxes& axes, const model::States& at,
                           bool by_all) {
  if (!machine.fitted || !machine.fitted->open_known) return StraightParts::Zero();
  constexpr std::size_t kFewPositions = 3;  // of each axis: the parts are linear in the positions
  const Matrix3Xd points = grid(axes, {kFewPositions, kFewPositions, kFewPositions});
  return variance_of(machine, by_all ? machine.fitted->factor : machine.fitted->open,
                     [&](const model::Machine& moved) -> VectorXd {
                       return straight_parts(points, needed(moved, axes, points, at));
                     })
      .cwiseSqrt();
}

/// Heights at the lowest Z without a constant offset, mm.
VectorXd heights_of(const model::Machine& machine, const ThreeAxes& axes, const model::States& at) {
  constexpr std::size_t kSide = 5;
  const VectorXd heights = needed(machine, axes, grid(axes, {kSide, kSide, 1}), at).row(2);
  return heights.array() - heights.mean();
}

/// Fits skew and steps, without the parts that the last fit did not measure. `by_all`: the whole standard
/// uncertainty counts beside that of the parameters that no reading determines.
void fit_straight_parts(PrinterCorrection& correction, const PrinterFeatures& features,
                        const model::Machine& machine, const ThreeAxes& axes, const model::States& at,
                        bool by_all) {
  constexpr std::size_t kPositions = 7;  // of each axis
  const Matrix3Xd points = grid(axes, {kPositions, kPositions, kPositions});
  StraightParts parts = straight_parts(points, needed(machine, axes, points, at));
  const StraightParts open = std_of_parts(machine, axes, at, false);
  const StraightParts std = by_all ? std_of_parts(machine, axes, at, true) : open;
  // A part that is 0, and that no parameter of the last fit changes, was not measured either; without a fit
  // none of them was.
  const StraightParts seen = std_of_parts(machine, axes, at, true);
  constexpr double kZero = 1e-9;  // rad, and part of a length: below the digits of all files
  const std::array<const char*, 6> names = {"XY", "XZ", "YZ", "X", "Y", "Z"};
  const std::array<std::size_t, 6> along = {1, 2, 2, 0, 1, 2};  // the axis over which the part adds up
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto i = static_cast<Index>(k);
    if (!(k < 3 ? features.skew : features.steps)) continue;
    const bool absent = std::abs(parts[i]) < kZero && seen[i] < kZero;
    // What no reading determines takes its value nearest zero: the part is too small by such a share.
    constexpr double kMostOpen = 0.1;
    const bool without_size = k >= 3 && !features.size_known;
    if (open[i] <= kMostOpen * std::abs(parts[i]) && std[i] <= kMostShare * std::abs(parts[i]) && !absent &&
        !without_size)
      continue;
    const double travel = axes.high[along[k]] - axes.low[along[k]];
    correction.unmeasured.push_back(
        {names[k], parts[i], std[i], absent ? 0 : 1000 * travel * std::max(std::abs(parts[i]), std[i])});
    parts[i] = 0;
  }
  correction.no_skew = std::count_if(correction.unmeasured.begin(), correction.unmeasured.end(),
                                     [](const UnmeasuredPart& one) { return one.name.size() == 2; }) == 3;
  if (features.skew) {
    correction.xy = parts[0];
    correction.xz = parts[1];
    correction.yz = parts[2];
  }
  if (features.steps) correction.steps = {1 + parts[3], 1 + parts[4], 1 + parts[5]};
}

/// Mean over the points of what each axis needs more when it moves forth than when it moves back, mm.
Eigen::Vector3d reversal_of(const model::Machine& machine, const ThreeAxes& axes, const Matrix3Xd& points,
                            const model::States& at) {
  Eigen::Vector3d reversal;
  for (std::size_t i = 0; i < 3; ++i) {
    model::States forth = at, back = at;
    forth.direction[axes.axis[i]].setConstant(1);
    back.direction[axes.axis[i]].setConstant(-1);
    const auto row = static_cast<Index>(i);
    reversal[row] =
        (needed(machine, axes, points, forth).row(row) - needed(machine, axes, points, back).row(row)).mean();
  }
  return reversal;
}

void fit_lost_motion(PrinterCorrection& correction, const model::Machine& machine, const ThreeAxes& axes,
                     const model::States& at) {
  constexpr std::size_t kPositions = 3;  // of each axis: the mean of a curve along the axis needs no more
  const Matrix3Xd points = grid(axes, {kPositions, kPositions, kPositions});
  const Eigen::Vector3d reversal = reversal_of(machine, axes, points, at);
  Eigen::Vector3d std = Eigen::Vector3d::Zero();
  if (machine.fitted && machine.fitted->open_known)
    std = variance_of(machine, machine.fitted->factor, [&](const model::Machine& moved) -> VectorXd {
            return reversal_of(moved, axes, points, at);
          }).cwiseSqrt();
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Index>(i);
    if (std[row] <= kMostShare * reversal[row] && maths::kUmPerMm * reversal[row] > kNothing_um)
      correction.lost_motion[i] = reversal[row];
  }
}

/// Heights at the lowest Z, beside the skew. They are 0 in the middle: homing sets the offset.
HeightMesh mesh_of(const model::Machine& machine, const ThreeAxes& axes, std::size_t count,
                   const model::States& at, const std::optional<Bed>& bed) {
  const Matrix3Xd points = grid(axes, {count, count, 1});
  const VectorXd offset = needed_heights(machine, axes, points, at, bed);
  HeightMesh mesh{axes.low[0], axes.high[0], axes.low[1], axes.high[1], {}};
  const auto side = static_cast<Index>(count);
  mesh.z.resize(side, side);
  for (Index row = 0; row < side; ++row) mesh.z.row(row) = offset.segment(row * side, side);
  const double middle = mesh.at((axes.low[0] + axes.high[0]) / 2, (axes.low[1] + axes.high[1]) / 2);
  mesh.z.array() -= middle;
  return mesh;
}

/// Largest error of the mesh in the middle of its cells, um.
double between_um(const model::Machine& machine, const ThreeAxes& axes, const HeightMesh& mesh,
                  const model::States& at, const std::optional<Bed>& bed) {
  const auto cells = static_cast<std::size_t>(mesh.z.cols() - 1);
  ThreeAxes middle = axes;
  for (std::size_t i = 0; i < 2; ++i) {
    const double half = (axes.high[i] - axes.low[i]) / static_cast<double>(2 * cells);
    middle.low[i] += half;
    middle.high[i] -= half;
  }
  const Matrix3Xd points = grid(middle, {cells, cells, 1});
  VectorXd error = needed_heights(machine, axes, points, at, bed);
  for (Index i = 0; i < points.cols(); ++i) error[i] -= mesh.at(points(0, i), points(1, i));
  return 1000 * (error.maxCoeff() - error.minCoeff()) / 2;
}

double rms_beside_mean_um(const std::vector<double>& mm) {
  const Eigen::Map<const VectorXd> all(mm.data(), static_cast<Index>(mm.size()));
  return 1000 * std::sqrt((all.array() - all.mean()).square().mean());
}

/// Removes the offset and the turn about Z that fit best.
void remove_rigid_part(Matrix3Xd& error, const Matrix3Xd& points) {
  const Eigen::Vector3d mean = error.rowwise().mean();
  error.colwise() -= mean;
  const Eigen::Vector3d centre = points.rowwise().mean();
  const Matrix3Xd arm = points.colwise() - centre;
  const double turn = (arm.row(0).dot(error.row(1)) - arm.row(1).dot(error.row(0))) /
                      (arm.row(0).squaredNorm() + arm.row(1).squaredNorm());
  error.row(0) += turn * arm.row(1);
  error.row(1) -= turn * arm.row(0);
}

/// The ranges of the axes over the bed.
ThreeAxes over_bed(ThreeAxes axes, const std::optional<Bed>& bed) {
  for (std::size_t i = 0; bed && i < 2; ++i) axes.low[i] = bed->low[i], axes.high[i] = bed->high[i];
  return axes;
}

}  // namespace

double Bed::height(double x, double y) const {
  if (shape) return shape->height(x, y);
  return place_mm.z() - (normal.x() * (x - place_mm.x()) + normal.y() * (y - place_mm.y())) / normal.z();
}

std::optional<Bed> bed_of(const model::Machine& machine, const ThreeAxes& axes, const std::string& name) {
  const std::vector<model::FitRecord::Plane> planes =
      machine.fitted ? machine.fitted->planes : std::vector<model::FitRecord::Plane>{};
  std::vector<std::string> names;
  const model::FitRecord::Plane* found = nullptr;
  for (const model::FitRecord::Plane& plane : planes) {
    names.push_back(plane.name);
    if (name.empty() || plane.name == name) found = &plane;
  }
  if (name.empty() && planes.empty()) return std::nullopt;
  if (found == nullptr)
    throw text::InputError({machine.file, 0}, name,
                           planes.empty()
                               ? "the last fit of this machine has no rows that touch a plane"
                               : fmt::format("the last fit has no plane of this name; its planes are {}",
                                             text::joined(names, ", ")));
  if (name.empty() && planes.size() > 1)
    throw text::InputError(
        {machine.file, 0}, "planes",
        fmt::format("the last fit has several planes ({}): state the name of the bed with --bed, or none",
                    text::joined(names, ", ")));
  Bed bed{found->name,
          {found->place_mm[0], found->place_mm[1], found->place_mm[2]},
          {found->normal[0], found->normal[1], found->normal[2]},
          {},
          {}};
  constexpr double kSteepest = 0.5;  // cosine of 60 deg: what is steeper is a wall
  if (std::abs(bed.normal.z()) < kSteepest)
    throw text::InputError({machine.file, 0}, found->name,
                           "this plane is nearly vertical: it cannot be the bed");
  for (std::size_t i = 0; i < 2; ++i) {
    bed.low[i] = axes.low[i], bed.high[i] = axes.high[i];
    double probe = 0;  // the probe touched beside the position of the axes
    for (const model::FitRecord::Range& range : machine.fitted->measured)
      if (range.name == format::columns::kProbe[i] && range.min == range.max) probe = range.min;
    for (const model::FitRecord::Range& range : machine.fitted->measured)
      if (range.name == kLetters[i] && range.max > range.min) {
        bed.low[i] = std::max(bed.low[i], range.min + probe);
        bed.high[i] = std::min(bed.high[i], range.max + probe);
      }
  }
  return bed;
}

Bed bed_of_touches(const model::Machine& machine, const ThreeAxes& axes, const model::Measurement& rows,
                   const std::string& name) {
  std::vector<std::string> names;
  for (const model::Thing& thing : rows.things)
    if (thing.artefact.type == model::ArtefactType::kPlane && !thing.in_measuring_frame() &&
        (name.empty() || name == thing.label) &&
        std::find(names.begin(), names.end(), thing.label) == names.end())
      names.push_back(thing.label);
  if (names.size() != 1)
    throw text::InputError(
        {machine.file, 0}, name.empty() ? "planes" : name,
        names.empty() ? "no row of --touches touches a plane of unknown position with this name"
                      : fmt::format("--touches has several planes ({}): state the name of the bed with --bed",
                                    text::joined(names, ", ")));
  return {names.front(),
          Eigen::Vector3d::Zero(),
          Eigen::Vector3d::UnitZ(),
          {axes.low[0], axes.low[1]},
          {axes.high[0], axes.high[1]}};
}

void give_shape(Bed& bed, const model::Machine& machine, const ThreeAxes& axes,
                const model::Measurement& rows) {
  bed.touches = bed_touches(machine, rows, bed.name);
  bed.shape.emplace(bed.touches);
  for (std::size_t i = 0; i < 2; ++i) {
    bed.low[i] = std::max(axes.low[i], bed.shape->low[i]);
    bed.high[i] = std::min(axes.high[i], bed.shape->high[i]);
    if (!(bed.high[i] > bed.low[i]))
      throw text::InputError({machine.file, 0}, bed.name,
                             "the touched points are outside the range of the axes, or on one line");
  }
}

double HeightMesh::at(double x, double y) const {
  if (z.size() == 0) return 0;
  const auto cell = [](double value, double low, double high, Index count) {
    const double share = (value - low) / (high - low) * static_cast<double>(count - 1);
    const double held = std::clamp(share, 0.0, static_cast<double>(count - 1));
    const Index first = std::min(static_cast<Index>(held), count - 2);
    return std::pair<Index, double>(first, held - static_cast<double>(first));
  };
  const auto [column, right] = cell(x, x_low, x_high, z.cols());
  const auto [row, up] = cell(y, y_low, y_high, z.rows());
  const double lower = (1 - right) * z(row, column) + right * z(row, column + 1);
  const double upper = (1 - right) * z(row + 1, column) + right * z(row + 1, column + 1);
  return (1 - up) * lower + up * upper;
}

Matrix3Xd PrinterCorrection::corrected(const Matrix3Xd& commands) const {
  Matrix3Xd result = commands;
  result.row(0) += xy * commands.row(1) + xz * commands.row(2);
  result.row(1) += yz * commands.row(2);
  for (Index i = 0; i < result.cols(); ++i) result(2, i) += mesh.at(result(0, i), result(1, i));
  for (std::size_t i = 0; i < 3; ++i) result.row(static_cast<Index>(i)) *= steps[i];
  return result;
}

bool PrinterCorrection::measured(const std::string& skew) const {
  return std::none_of(unmeasured.begin(), unmeasured.end(),
                      [&](const UnmeasuredPart& one) { return one.name == skew; });
}

bool PrinterCorrection::empty() const {
  return !has_mesh() && xy == 0 && xz == 0 && yz == 0 && steps == std::array<double, 3>{1, 1, 1} &&
         lost_motion == std::array<double, 3>{};
}

bool heights_are_measured(const model::Machine& machine, const ThreeAxes& axes, const model::States& at) {
  const VectorXd heights = heights_of(machine, axes, at);
  if (!(1000 * heights.cwiseAbs().maxCoeff() > kNothing_um)) return false;
  if (!machine.fitted || !machine.fitted->open_known) return true;
  const VectorXd variance = variance_of(machine, machine.fitted->open, [&](const model::Machine& moved) {
    return heights_of(moved, axes, at);
  });
  return std::sqrt(variance.sum()) <= kMostShare * heights.norm();
}

namespace {

/// Heights of the touches without and with the mesh, as the firmware sees them (with straight axes), mm.
struct TouchHeights {
  bool of_nozzle = false;
  double rise = 1;  // of the point with the command of Z; -1: a bed that moves along Z itself
  std::vector<double> before, after;
};

/// The heights of the nozzle's touches in the region of the mesh, if there are three or more, otherwise of
/// the probe's.
std::optional<TouchHeights> heights_at_touches(const model::Machine& machine, const ThreeAxes& axes,
                                               const HeightMesh& mesh, const model::States& at,
                                               const Bed& bed) {
  const Eigen::Vector3d middle((mesh.x_low + mesh.x_high) / 2, (mesh.y_low + mesh.y_high) / 2, axes.low[2]);
  const Matrix3Xd ends = nominal_points(
      machine, axes,
      Matrix3Xd{{middle.x(), middle.x()}, {middle.y(), middle.y()}, {middle.z(), middle.z() + 1}}, at);
  constexpr std::size_t kFew = 3;
  for (const bool of_nozzle : {true, false}) {
    TouchHeights heights{of_nozzle, ends(2, 1) - ends(2, 0), {}, {}};
    const double at_zero = ends(2, 0) - heights.rise * middle.z();  // height where Z is 0
    for (const BedTouch& touch : bed.touches) {
      const double x = touch.nominal.x(), y = touch.nominal.y();
      constexpr double kEdge_mm = 1e-3;
      const bool inside = x > mesh.x_low - kEdge_mm && x < mesh.x_high + kEdge_mm &&
                          y > mesh.y_low - kEdge_mm && y < mesh.y_high + kEdge_mm;
      if (!inside || touch.of_nozzle() != of_nozzle) continue;
      heights.before.push_back(touch.nominal.z() - at_zero);
      heights.after.push_back(heights.before.back() - heights.rise * mesh.at(x, y));
    }
    if (heights.before.size() >= kFew) return heights;
  }
  return std::nullopt;
}

/// Gives the mesh the zero of the touches: with it, the offset of Z of the printer stays what it is.
void keep_zero_of_touches(HeightMesh& mesh, const model::Machine& machine, const ThreeAxes& axes,
                          const model::States& at, const Bed& bed) {
  const auto heights = heights_at_touches(machine, axes, mesh, at, bed);
  if (!heights || heights->rise == 0) return;
  const Eigen::Map<const VectorXd> left(heights->after.data(), static_cast<Index>(heights->after.size()));
  mesh.z.array() += left.mean() / heights->rise;
}

}  // namespace

std::optional<TouchResidual> touch_residual(const model::Machine& machine, const ThreeAxes& axes,
                                            const PrinterCorrection& correction, const model::States& at,
                                            const Bed& bed) {
  if (!correction.has_mesh()) return std::nullopt;
  const auto heights = heights_at_touches(machine, axes, correction.mesh, at, bed);
  if (!heights) return std::nullopt;
  return TouchResidual{heights->before.size(), heights->of_nozzle, rms_beside_mean_um(heights->before),
                       rms_beside_mean_um(heights->after)};
}

PrinterCorrection printer_correction(const model::Machine& machine, const ThreeAxes& axes,
                                     const PrinterFeatures& features, const model::States& at,
                                     double tolerance_um, const std::optional<Bed>& bed,
                                     const model::Machine* straight) {
  PrinterCorrection correction;
  fit_straight_parts(correction, features, straight != nullptr ? *straight : machine, axes, at,
                     straight != nullptr);
  if (features.lost_motion) fit_lost_motion(correction, straight != nullptr ? *straight : machine, axes, at);
  if (!features.mesh) return correction;
  const ThreeAxes over = over_bed(axes, bed);
  for (const std::size_t count : features.points) {
    correction.mesh = mesh_of(machine, over, count, at, bed);
    if (between_um(machine, over, correction.mesh, at, bed) <= tolerance_um) break;
  }
  if (bed && bed->shape) keep_zero_of_touches(correction.mesh, machine, axes, at, *bed);
  return correction;
}

namespace {

constexpr Index kPositions = 4096;

/// Random positions in the ranges of the axes (fixed seed).
Matrix3Xd positions_in(const ThreeAxes& axes) {
  constexpr unsigned long kPositionsSeed = 1;
  std::mt19937_64 random(kPositionsSeed);
  Matrix3Xd points(3, kPositions);
  for (std::size_t i = 0; i < 3; ++i) {
    std::uniform_real_distribution<double> position(axes.low[i], axes.high[i]);
    for (Index k = 0; k < kPositions; ++k) points(static_cast<Index>(i), k) = position(random);
  }
  return points;
}

/// Errors with the correction, or without (nullptr), heights counted from the bed; without their rigid part.
Matrix3Xd errors_at(const model::Machine& machine, const ThreeAxes& axes, const Matrix3Xd& points,
                    const PrinterCorrection* correction, const model::States& at,
                    const std::optional<Bed>& bed) {
  Matrix3Xd nominal = nominal_points(machine, axes, points, at);
  nominal.row(2) += bed_heights(bed, nominal).transpose();
  const Matrix3Xd commands = correction != nullptr ? correction->corrected(points) : points;
  Matrix3Xd error = model::forward(machine, states_at(axes, commands, at)).position - nominal;
  remove_rigid_part(error, nominal);
  return error;
}

}  // namespace

PrinterErrors printer_errors(const model::Machine& machine, const ThreeAxes& axes,
                             const PrinterCorrection& correction, const model::States& at,
                             const std::optional<Bed>& bed) {
  const Matrix3Xd points = positions_in(over_bed(axes, bed));
  const Matrix3Xd before = errors_at(machine, axes, points, nullptr, at, bed),
                  after = errors_at(machine, axes, points, &correction, at, bed);
  PrinterErrors errors;
  errors.positions = static_cast<std::size_t>(kPositions);
  for (std::size_t i = 0; i < 3; ++i) {
    errors.before_um[i] = 1000 * before.row(static_cast<Index>(i)).cwiseAbs().maxCoeff();
    errors.after_um[i] = 1000 * after.row(static_cast<Index>(i)).cwiseAbs().maxCoeff();
  }
  errors.rms_before_um = rms_um(before);
  errors.rms_after_um = rms_um(after);
  if (bed)
    errors.beyond_bed_um =
        1000 *
        errors_at(machine, axes, positions_in(axes), &correction, at, bed).row(2).cwiseAbs().maxCoeff();
  return errors;
}

namespace {

/// The lowest and the highest value of an input for which errors are stated.
std::array<double, 2> range_of(const model::Machine& machine, const model::Input& input) {
  constexpr double kBeside = 10;  // K or units of the input, on both sides of the reference
  std::array<double, 2> range = {input.reference - kBeside, input.reference + kBeside};
  if (machine.fitted)
    for (const model::FitRecord::Range& measured : machine.fitted->measured)
      if (measured.name == input.name && measured.max > measured.min) range = {measured.min, measured.max};
  return {input.min.value_or(range[0]), input.max.value_or(range[1])};
}

}  // namespace

std::vector<LeftOut> errors_of_inputs(const model::Machine& machine, const ThreeAxes& axes,
                                      const PrinterCorrection& correction, const model::States& at,
                                      const std::optional<Bed>& bed) {
  const Matrix3Xd points = positions_in(over_bed(axes, bed));
  const Matrix3Xd held = errors_at(machine, axes, points, &correction, at, bed);
  std::vector<LeftOut> left;
  for (std::size_t k = 0; k < machine.inputs.size(); ++k) {
    const model::Input& input = machine.inputs[k];
    // The position of a probe is no state of the machine.
    if (std::find(format::columns::kProbe.begin(), format::columns::kProbe.end(), input.name) !=
        format::columns::kProbe.end())
      continue;
    for (const double value : range_of(machine, input)) {
      model::States changed = at;
      changed.input[k].setConstant(value);
      const Matrix3Xd change = errors_at(machine, axes, points, &correction, changed, bed) - held;
      const double um = 1000 * change.colwise().norm().maxCoeff();
      if (!(um > kNothing_um)) continue;
      left.push_back(
          {fmt::format("change of the error of the tool point: the files hold {0} = {1:g} {2}, and "
                       "not {0} = {3:g} {2}",
                       input.name, at.input[k][0], input.unit, value),
           um});
    }
  }
  return left;
}

}  // namespace vernier::exchange
