// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/sanity.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>

#include "tools/fit/convention.h"
#include "tools/fit/coverage/pose_readings.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/format/readings.h"
#include "tools/format/units.h"
#include "tools/maths/decompositions.h"
#include "tools/maths/factors.h"
#include "tools/maths/median.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/work_poses.h"

namespace vernier::fit {
namespace {

/// Largest share of the misfit that remains after a mistake is undone.
constexpr double kFivefold = 0.2;

std::string reading_name(const model::Measurement& m, const model::Observation& o) {
  return fmt::format("{}:{} {}", m.files[m.file[o.row]], m.line[o.row], format::name_of(o.kind));
}

struct Mistake {
  std::string sentence;
  std::function<void(model::Measurement&)> undo;
};

void swap_kinds(model::Measurement& m, model::ObservationKind a, model::ObservationKind b) {
  for (model::Observation& o : m.observations) o.kind = o.kind == a ? b : o.kind == b ? a : o.kind;
}

void scale_rotations(model::Measurement& m, double factor) {
  for (model::Observation& o : m.observations)
    if (model::is_rotation(o.kind)) o.value *= factor;
}

/// Unit of a length in which mm were expected, and the factor that corrects it.
constexpr std::array<std::pair<const char*, double>, 6> kLengthUnits = {
    {{"in inches", 25.4},
     {"in centimetres", 10},
     {"a thousand times too small (values in m stated as mm, or values in mm stated as um)", 1000},
     {"a thousand times too large (values in um, stated as mm)", 1e-3},
     {"millimetres taken for centimetres", 0.1},
     {"millimetres taken for inches", 1 / 25.4}}};

void add_mistakes_of_readings(const model::Measurement& rows, std::vector<Mistake>& list) {
  constexpr std::array kKinds = {model::ObservationKind::kX, model::ObservationKind::kY,
                                 model::ObservationKind::kZ};
  const auto name = [](model::ObservationKind kind) { return format::name_of(kind); };
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = a + 1; b < 3; ++b)
      list.push_back({fmt::format("the columns {} and {} look swapped", name(kKinds[a]), name(kKinds[b])),
                      [=](model::Measurement& mended) { swap_kinds(mended, kKinds[a], kKinds[b]); }});
  for (const model::ObservationKind kind : kKinds)
    list.push_back({fmt::format("the column {} probably has the wrong sign", name(kind)),
                    [=](model::Measurement& mended) {
                      for (model::Observation& o : mended.observations)
                        if (o.kind == kind) o.value = -o.value;
                    }});
  std::set<model::ObservationKind> lengths;
  for (const model::Observation& o : rows.observations)
    if (!model::is_rotation(o.kind)) lengths.insert(o.kind);
  for (const auto& [unit, factor] : kLengthUnits) {
    list.push_back({fmt::format("the readings look as if they were {}", unit),
                    [factor = factor](model::Measurement& mended) {
                      for (model::Observation& o : mended.observations)
                        if (!model::is_rotation(o.kind)) o.value *= factor;
                    }});
    if (lengths.size() < 2) continue;
    for (const model::ObservationKind kind : lengths)
      list.push_back({fmt::format("the column {} looks as if it were {}", name(kind), unit),
                      [=, factor = factor](model::Measurement& mended) {
                        for (model::Observation& o : mended.observations)
                          if (o.kind == kind) o.value *= factor;
                      }});
  }
  list.push_back({"the rotations are stated in deg, but are probably in rad",
                  [](model::Measurement& mended) { scale_rotations(mended, maths::kDegPerRad); }});
  list.push_back({"the rotations are stated in rad, but are probably in deg",
                  [](model::Measurement& mended) { scale_rotations(mended, 1 / maths::kDegPerRad); }});
  const std::vector<SixReadings> poses = complete_poses(rows);
  for (const bool of_board : {true, false})
    if (std::any_of(poses.begin(), poses.end(), [=](const auto& pose) { return pose.of_board == of_board; }))
      list.push_back(
          {"the poses are probably inverted: the frame of the camera (or instrument) and the frame of the "
           "measured object are exchanged",
           [=](model::Measurement& mended) { invert_poses(mended, of_board); }});
}

void add_mistakes_of_positions(const model::Machine& machine, std::vector<Mistake>& list) {
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const std::string& name = machine.axes[a].name;
    for (std::size_t b = a + 1; b < machine.axes.size(); ++b)
      if (machine.axes[a].rotary == machine.axes[b].rotary)
        list.push_back(
            {fmt::format("the columns {} and {} look swapped", name, machine.axes[b].name),
             [=](model::Measurement& rows) { std::swap(rows.states.axis[a], rows.states.axis[b]); }});
    const auto scaled = [&](const char* what, double factor) {
      list.push_back({fmt::format("the column {} looks as if it were {}", name, what),
                      [=](model::Measurement& rows) { rows.states.axis[a] *= factor; }});
    };
    scaled("of the other sign", -1);
    if (machine.axes[a].rotary) {
      scaled("in radians", maths::kDegPerRad);
      scaled("degrees taken for radians", 1 / maths::kDegPerRad);
    } else {
      for (const auto& [unit, factor] : kLengthUnits) scaled(unit, factor);
    }
  }
  const auto rotary = std::count_if(machine.axes.begin(), machine.axes.end(),
                                    [](const model::Axis& axis) { return axis.rotary; });
  if (rotary < 2) return;
  std::vector<std::size_t> all;
  for (std::size_t a = 0; a < machine.axes.size(); ++a)
    if (machine.axes[a].rotary) all.push_back(a);
  for (const auto& [what, factor] : {std::pair("in radians", maths::kDegPerRad),
                                     std::pair("degrees taken for radians", 1 / maths::kDegPerRad)})
    list.push_back({fmt::format("the positions of all rotary axes look as if they were {}", what),
                    [all, factor = factor](model::Measurement& rows) {
                      for (const std::size_t a : all) rows.states.axis[a] *= factor;
                    }});
}

std::vector<Mistake> mistakes_of(const model::Machine& machine, const model::Measurement& rows) {
  std::vector<Mistake> list;
  add_mistakes_of_readings(rows, list);
  add_mistakes_of_positions(machine, list);
  return list;
}

std::size_t positions_out_of_range(const model::Machine& machine, const model::Measurement& m) {
  std::size_t count = 0;
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const model::Axis& axis = machine.axes[a];
    if (!axis.min || !axis.max || axis.rollover) continue;
    for (const double q : m.states.axis[a]) count += q < *axis.min || q > *axis.max ? 1 : 0;
  }
  return count;
}

/// Returns the first axis position that is outside the axis' range by more than half of the range.
/// Empty: no such position.
std::string cell_out_of_range(const model::Machine& machine, const model::Measurement& m) {
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const model::Axis& axis = machine.axes[a];
    if (!axis.min || !axis.max || axis.rollover) continue;
    const double margin = 0.5 * (*axis.max - *axis.min);
    for (std::size_t row = 0; row < m.rows(); ++row) {
      const double q = m.states.axis[a][static_cast<Eigen::Index>(row)];
      if (m.check[row] != 0 || (q >= *axis.min - margin && q <= *axis.max + margin)) continue;
      return fmt::format("{}:{} {} {:g} is far outside the range of the axis", m.files[m.file[row]],
                         m.line[row], axis.name, q);
    }
  }
  return {};
}

/// Standard deviation of the length readings of each kind about their mean, mm; infinite without lengths.
double spread_of_lengths(const model::Measurement& rows) {
  struct Sums {
    double count = 0, sum = 0, squares = 0;
  };
  std::map<model::ObservationKind, Sums> of_kind;
  for (const model::Observation& o : rows.observations) {
    if (model::is_rotation(o.kind) || rows.check[o.row] != 0) continue;
    Sums& sums = of_kind[o.kind];
    sums.count += 1;
    sums.sum += o.value;
    sums.squares += o.value * o.value;
  }
  double squares = 0, count = 0;
  for (const auto& [kind, sums] : of_kind) {
    squares += sums.squares - sums.sum * sums.sum / sums.count;
    count += sums.count;
  }
  return count > 0 ? std::sqrt(std::max(0.0, squares) / count) : std::numeric_limits<double>::infinity();
}

/// The direction in which a machine moves the tool least, compared with another machine at the same poses.
struct LeastMotion {
  double share = 1;                                 // of the motion of the other machine
  Eigen::Vector3d along = Eigen::Vector3d::Zero();  // unit vector
};

/// The linear map from positions of the nominal machine to those of the fitted one, 3 x n each, has one
/// singular value per direction. Directions in which the nominal machine hardly moves are excluded, because
/// errors across them would decide.
LeastMotion least_motion(const Eigen::Matrix3Xd& fitted, const Eigen::Matrix3Xd& nominal) {
  constexpr double kMoves = 1e-3;  // share of the largest motion
  const Eigen::MatrixXd of_nominal = nominal.colwise() - nominal.rowwise().mean();
  const Eigen::MatrixXd of_fitted = fitted.colwise() - fitted.rowwise().mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spread(of_nominal * of_nominal.transpose());
  const Eigen::VectorXd& squares = spread.eigenvalues();  // ascending
  Eigen::Index excluded = 0;
  while (excluded < 3 && !(squares[excluded] > kMoves * kMoves * squares[2])) ++excluded;
  if (excluded == 3) return {};
  const Eigen::MatrixXd directions = spread.eigenvectors().rightCols(3 - excluded);
  const Eigen::MatrixXd map = of_fitted * of_nominal.transpose() * directions *
                              squares.tail(3 - excluded).cwiseInverse().asDiagonal();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(map, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::Index least = svd.singularValues().size() - 1;
  return {svd.singularValues()[least], directions * svd.matrixV().col(least)};
}

/// Lowest and highest position of each axis.
using Ranges = std::vector<std::array<double, 2>>;

/// Compares two machines at poses over these ranges of the axes.
LeastMotion least_motion_over(const model::Machine& fitted, const model::Machine& nominal,
                              const Ranges& ranges) {
  const model::States states = model::poses_over(nominal, ranges).states;
  return least_motion(model::forward(fitted, states).position, model::forward(nominal, states).position);
}

/// The nominal machine with the set-ups of the fitted one, so that it has all its parameters.
model::Machine nominal_in_set_ups(const model::Machine& fitted) {
  model::Machine nominal = model::nominal_machine(fitted);
  nominal.base_shifts = fitted.base_shifts;
  nominal.tool_shifts = fitted.tool_shifts;
  return nominal;
}

std::array<double, 2> measured_range(const model::Measurement& m, std::size_t axis) {
  return {m.states.axis[axis].minCoeff(), m.states.axis[axis].maxCoeff()};
}

/// Ranges of the axes: those of the machine file, or the measured ones.
Ranges ranges_of(const model::Machine& machine, const model::Measurement& m) {
  Ranges ranges;
  for (std::size_t a = 0; a < machine.axes.size(); ++a)
    ranges.push_back(model::work_range(machine, a).value_or(measured_range(m, a)));
  return ranges;
}

/// Distance of the tool point at the two ends of an axis, the other axes in the middle, mm.
double travel_of(const model::Machine& machine, const Ranges& ranges, std::size_t axis) {
  model::States states = model::make_states(2, machine);
  for (std::size_t a = 0; a < ranges.size(); ++a)
    for (Eigen::Index end = 0; end < 2; ++end)
      states.axis[a][end] =
          a == axis ? ranges[a][static_cast<std::size_t>(end)] : (ranges[a][0] + ranges[a][1]) / 2;
  const Eigen::Matrix3Xd ends = model::forward(machine, states).position;
  return (ends.col(1) - ends.col(0)).norm();
}

/// Rms distance of the tool points over these ranges from their mean, mm.
double spread_of(const model::Machine& machine, const Ranges& ranges) {
  const Eigen::Matrix3Xd points = model::forward(machine, model::poses_over(machine, ranges).states).position;
  return (points.colwise() - points.rowwise().mean()).norm() / std::sqrt(static_cast<double>(points.cols()));
}

/// "along Y", or "along the direction (0.7, 0.7, 0)".
std::string direction_text(const Eigen::Vector3d& along) {
  constexpr double kAlong = 0.98;  // cosine of 11 deg
  Eigen::Index largest = 0;
  if (along.cwiseAbs().maxCoeff(&largest) > kAlong) return fmt::format("along {}", "XYZ"[largest]);
  return fmt::format("along the direction ({:.2f}, {:.2f}, {:.2f})", along.x(), along.y(), along.z());
}

}  // namespace

std::string collapse_of(const model::Machine& fitted, const model::ParameterSet& parameters,
                        const model::Measurement& measurement) {
  constexpr double kLeast = 0.5;          // no calibration halves a machine
  constexpr double kLeastOfTravel = 0.1;  // positions that vary by noise alone show the machine as well
  if (measurement.things.empty()) return {};
  const model::Machine nominal = model::nominal_machine(fitted);
  Ranges ranges;
  for (std::size_t a = 0; a < fitted.axes.size(); ++a) {
    std::array<double, 2> range = measured_range(measurement, a);
    if (const auto travel = model::work_range(nominal, a)) {
      const double wider = kLeastOfTravel * ((*travel)[1] - (*travel)[0]) - (range[1] - range[0]);
      range[0] -= std::max(0.0, wider) / 2;
      range[1] += std::max(0.0, wider) / 2;
    }
    ranges.push_back(range);
  }
  const LeastMotion least = least_motion_over(fitted, nominal, ranges);
  if (!(least.share < kLeast)) return {};
  // A parameter that stops the motion alone.
  const Eigen::VectorXd values = parameters.get(fitted);
  const model::Machine here = nominal_in_set_ups(fitted);
  const Eigen::VectorXd before = parameters.get(here);
  std::string alone;
  for (std::size_t i = 0; i < parameters.size() && alone.empty(); ++i) {
    if (model::is_set_up(parameters[i].kind)) continue;
    const auto at = static_cast<Eigen::Index>(i);
    Eigen::VectorXd one = before;
    one[at] = values[at];
    model::Machine changed = here;
    parameters.set(changed, one);
    if (least_motion_over(changed, here, ranges).share < kLeast) alone = parameters[i].name;
  }
  return fmt::format(
      "{} the fitted machine moves the tool by only {:.3g} of the nominal distance{}: touches of unknown "
      "points agree best if the machine does not move; perhaps two labels are exchanged, or each point was "
      "touched from positions that do not vary enough{}",
      direction_text(least.along), least.share, alone.empty() ? "" : ", by " + alone + " alone",
      alone.empty() ? "" : fmt::format(". Hold {} at its nominal value (Hide=\"true\")", alone));
}

std::string far_from_nominal(const model::Machine& fitted, const model::ParameterSet& parameters,
                             const model::Measurement& measurement, double reach_mm) {
  constexpr double kStretch = 0.05;      // of the motion of a linear axis, over its travel
  constexpr double kTurnDeg = 45;        // of a constant
  constexpr double kShareOfSize = 0.25;  // of a length
  if (measurement.things.empty()) return {};
  const model::Machine nominal = model::nominal_machine(fitted);
  const char* const mend =
      "Touches of unknown points can agree with another machine than that of the file: check the sign, the "
      "unit and the motion of each axis. If the machine is really so, write the fitted value into the "
      "machine file as `nominal` and fit again.";
  const Ranges ranges = ranges_of(nominal, measurement);
  const double size_mm = std::max(reach_mm, spread_of(nominal, ranges));
  const Eigen::VectorXd now = parameters.get(fitted), before = parameters.get(nominal_in_set_ups(fitted));
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const model::Parameter& one = parameters[i];
    if (one.kind != model::ParameterKind::kStatic) continue;
    const auto unit = format::find_unit(one.unit);
    if (!unit) continue;
    const double moved = now[static_cast<Eigen::Index>(i)] - before[static_cast<Eigen::Index>(i)];
    const bool turned =
        unit->dimension == format::Dimension::kAngle && std::abs(moved * unit->factor) > kTurnDeg;
    const bool shifted = unit->dimension == format::Dimension::kLength &&
                         std::abs(moved * unit->factor) > kShareOfSize * size_mm;
    if (turned || shifted)
      return fmt::format("The fit moved {} by {:.4g} {} from its nominal value. {}", one.name, moved,
                         one.unit, mend);
  }
  for (std::size_t a = 0; a < fitted.axes.size(); ++a) {
    if (fitted.axes[a].rotary) continue;
    const double before_mm = travel_of(nominal, ranges, a), now_mm = travel_of(fitted, ranges, a);
    if (!(before_mm > 0) || std::abs(now_mm / before_mm - 1) < kStretch) continue;
    return fmt::format("The fit changed the motion of {}: {:.3g} of the nominal motion over its travel. {}",
                       fitted.axes[a].name, now_mm / before_mm, mend);
  }
  return {};
}

double half_travel_mm(const model::Machine& machine) {
  double squares = 0;
  for (const model::Axis& axis : machine.axes)
    if (!axis.rotary && axis.min && axis.max) squares += std::pow(*axis.max - *axis.min, 2);
  return std::sqrt(squares) / 2;
}

WorstReading worst_reading(const model::Measurement& measurement, const Eigen::VectorXd& residual,
                           bool check) {
  const bool with_u = has_uncertainty(measurement);
  std::vector<double> sizes;
  double squares = 0, largest = 0;
  WorstReading worst;
  for (std::size_t i = 0; i < measurement.observations.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const std::size_t row = measurement.observations[i].row;
    if ((measurement.check[row] != 0) != check) continue;
    const double u = model::uncertainty_of(measurement, measurement.observations[i]);
    const double size = std::abs(with_u && u > 0 ? residual[at] / u : residual[at]);
    sizes.push_back(size);
    squares += size * size;
    if (size <= largest) continue;
    largest = size;
    worst.reading = reading_name(measurement, measurement.observations[i]);
  }
  if (sizes.empty() || largest <= 0) return worst;
  // A spread below the stated uncertainty, or below the resolution of the file's digits, is not
  // evaluated.
  const double least = with_u ? 1 : 1e-4;
  worst.ratio = largest / std::max(maths::robust_spread(std::move(sizes)), least);
  worst.share = largest * largest / squares;
  return worst;
}

std::string unbelievable_u(const model::Measurement& measurement, const Eigen::VectorXd& residual) {
  constexpr double kUnbelievable = 300;  // a model that misses an effect leaves tens of times u
  std::vector<std::vector<double>> ratios(measurement.files.size()), lengths(measurement.files.size());
  for (std::size_t i = 0; i < measurement.observations.size(); ++i) {
    const model::Observation& one = measurement.observations[i];
    const double u = model::uncertainty_of(measurement, one);
    if (!(u > 0) || is_rotation(one.kind) || measurement.check[one.row] != 0) continue;
    ratios[measurement.file[one.row]].push_back(std::abs(residual[static_cast<Eigen::Index>(i)]) / u);
    lengths[measurement.file[one.row]].push_back(u);
  }
  for (std::size_t file = 0; file < ratios.size(); ++file) {
    if (ratios[file].empty()) continue;
    const double times = maths::median(std::move(ratios[file])),
                 u_um = maths::kUmPerMm * maths::median(std::move(lengths[file]));
    // A fit that diverged leaves hundreds of times a true u too.
    if (times > kUnbelievable && u_um < kSmallestU_um)
      return fmt::format(
          "the residual of {} is {:.2g} times the standard uncertainty u of its readings ({:.2g} um): "
          "probably this u is in another unit (5 um = 0.005 mm). Correct u, or remove it",
          measurement.files[file], times, u_um);
  }
  return {};
}

LikelyMistake likely_mistake(const model::Machine& machine, const model::Measurement& rows,
                             const WorstReading& worst, bool plausible) {
  // Share of chi^2 in one reading; another mistake with so small a remainder is equally likely.
  constexpr double kMostOfAll = 0.5, kAsGood = 1.5;
  if (const std::string cell = cell_out_of_range(machine, rows); !cell.empty()) return {cell, false};
  if (worst.share > kMostOfAll)
    return {fmt::format("{} is an outlier: no other reading has such a large residual", worst.reading), true};
  const model::ParameterSet none;
  const double misfit_mm = convention_of(machine, rows, none).misfit_mm;
  struct Found {
    double left_mm = 0;
    std::size_t outside = 0;  // axis positions outside their range after it is undone
    std::string sentence;
  };
  std::vector<Found> found;
  for (const Mistake& mistake : mistakes_of(machine, rows)) {
    model::Measurement mended = rows;
    mistake.undo(mended);
    const double left_mm = convention_of(machine, mended, none).misfit_mm;
    if (left_mm < kFivefold * misfit_mm && (!plausible || left_mm <= kFivefold * spread_of_lengths(mended)))
      found.push_back({left_mm, positions_out_of_range(machine, mended), mistake.sentence});
  }
  if (found.empty()) return {};
  // A mirrored frame can have several causes. All causes with the same remainder are reported,
  // except those with axes outside their ranges.
  const auto less = [](const Found& a, const Found& b) { return a.left_mm < b.left_mm; };
  const double least_mm = std::min_element(found.begin(), found.end(), less)->left_mm;
  std::erase_if(found, [&](const Found& one) { return one.left_mm > kAsGood * least_mm; });
  std::size_t outside = found.front().outside;
  for (const Found& one : found) outside = std::min(outside, one.outside);
  std::string sentence;
  for (const Found& one : found)
    if (one.outside == outside) sentence += (sentence.empty() ? "" : ", or ") + one.sentence;
  return {sentence, false};
}

namespace {

/// A sentence if the rows of each file agree with the machine alone, but not together.
std::string moved_between_files(const model::Machine& machine, const model::Measurement& rows,
                                double misfit_mm) {
  if (rows.files.size() < 2) return {};
  for (std::size_t file = 0; file < rows.files.size(); ++file) {
    std::vector<std::size_t> of_file;
    for (std::size_t row = 0; row < rows.rows(); ++row)
      if (rows.file[row] == file) of_file.push_back(row);
    const double alone =
        convention_of(machine, model::select_rows(rows, of_file), model::ParameterSet()).misfit_mm;
    if (!(alone < kFivefold * misfit_mm)) return {};
  }
  // Words in `setup` would separate the touched objects, and with them what the files have in common.
  if (!rows.things.empty())
    return fmt::format(
        "each file agrees with the machine alone, but not together: the touched object has another height or "
        "tilt in {} than in {} (bed screws, height of the probe). If the object was moved between the files, "
        "fit each file alone; otherwise correct the heights of one file by the difference{}",
        rows.files[1], rows.files[0],
        has_uncertainty(rows) ? "" : ". State the standard uncertainty u of the touches");
  return fmt::format(
      "each file agrees with the machine alone, so the instrument had different positions; the "
      "rows of {} and {} share one BaseShift: give them different words in a column \"setup\"",
      rows.files[0], rows.files[1]);
}

}  // namespace

std::string missing_set_up(const model::Machine& machine, const model::Measurement& rows, double misfit_mm) {
  if (!machine.base_shifts.empty()) return moved_between_files(machine, rows, misfit_mm);
  model::Machine placed = machine;
  placed.base_shifts.emplace_back();
  if (!(convention_of(placed, rows, model::ParameterSet()).misfit_mm < kFivefold * misfit_mm)) return {};
  return "the readings are in another frame than that of the machine file; write <BaseShift/> into <static>, "
         "so that the fit estimates the position of the instrument";
}

}  // namespace vernier::fit
