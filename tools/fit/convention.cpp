// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/convention.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "tools/fit/coverage/seen_beside_things.h"
#include "tools/fit/coverage/unseen_turns.h"
#include "tools/fit/least_squares/levenberg.h"
#include "tools/fit/least_squares/problem.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/fit/set_up.h"
#include "tools/format/units.h"
#include "tools/maths/decompositions.h"
#include "tools/maths/factors.h"
#include "tools/model/chain/chain_rows.h"
#include "tools/model/chain/evaluate.h"
#include "tools/model/chain/things.h"

namespace vernier::fit {
namespace {

/// A single error of three times the total residual is already implausible.
constexpr double kTimesMisfit = 3;
/// Touched objects of unknown place follow the errors of the machine, so the residual does not limit these
/// errors. Limit of an error as a share of the reach, then: robots made by hand have such errors.
constexpr double kMostError = 0.01;
/// The smallest misfit for scales, mm: a tenth of the finest resolution of any instrument here.
constexpr double kLeastMisfit_mm = 1e-5;
/// Set-ups: any position in a hall, any orientation.
constexpr double kAnywhere_mm = 1e5, kAnyTurn_deg = 360;

/// Kinds in addition to those of the tables (1 to 4).
constexpr int kLengthStatics = Convention::kFirstOfStatics, kAngleStatics = 6, kOtherStatics = 7;

/// Collects statics that change the shape of a term and not its size: in a divisor, an exponent,
/// or a time constant.
void collect_shapes(const model::Expr& expr, bool inside, std::set<std::size_t>& shapes) {
  if (expr.op == model::Op::kSymbol && expr.symbol.kind == model::SymbolKind::kStatic && inside)
    shapes.insert(expr.symbol.index);
  for (std::size_t i = 0; i < expr.args.size(); ++i) {
    const bool second = i == 1 && (expr.op == model::Op::kDivide || expr.op == model::Op::kPower ||
                                   expr.op == model::Op::kLag);
    collect_shapes(*expr.args[i],
                   inside || second || expr.op == model::Op::kExp || expr.op == model::Op::kLog, shapes);
  }
}

std::set<std::size_t> shape_statics(const model::Machine& machine) {
  std::set<std::size_t> shapes;
  for (const auto* branch : {&machine.tool, &machine.workpiece})
    for (const model::Transform& transform : *branch)
      for (std::size_t d = 0; d < transform.dof_count(); ++d)
        collect_shapes(*transform.dof[d], false, shapes);
  return shapes;
}

/// Values at which parameters stay: statics at nominal (or at their value), tables 0, set-ups as
/// fitted.
model::Machine centre_of(const model::Machine& machine) {
  model::Machine centre = machine;
  const model::ParameterSet parameters(machine, {});  // no runs: without set-ups
  Eigen::VectorXd values = parameters.get(machine);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    double& value = values[static_cast<Eigen::Index>(i)];
    value = parameters[i].kind == model::ParameterKind::kStatic
                ? machine.statics[parameters[i].item].nominal.value_or(value)
                : 0;
  }
  parameters.set(centre, values);
  return centre;
}

struct Misfit {
  double length_mm = 0, turn_rad = 0;
};

/// Rms of the known values of touched objects minus their estimates, mm. An object of uncertain place follows
/// the tool points: an error of the machine is then in its place, and not in the residual. 0: no uncertain
/// value.
double moved_things_mm(const model::Machine& machine, const model::Measurement& m) {
  if (m.things.empty()) return 0;
  const model::ChainRows chain(machine, m.states);
  const model::Things things(machine, m);
  const model::ThingsAt at(things, machine, chain);
  double squares = 0, count = 0;
  for (std::size_t cluster = 0; cluster < things.clusters(); ++cluster) {
    const model::ThingsAt::Known known = at.known(cluster);
    for (Eigen::Index k = 0; k < known.off.size(); ++k) {
      if (known.precision[k] == 0) continue;
      squares += known.off[k] * known.off[k];
      ++count;
    }
  }
  return count > 0 ? std::sqrt(squares / count) : 0;
}

Misfit misfit_of(const model::Machine& machine, const model::Measurement& m) {
  const Eigen::VectorXd residual = residuals(machine, m);
  Misfit misfit;
  double lengths = 0, turns = 0;
  for (std::size_t i = 0; i < m.observations.size(); ++i) {
    const model::Observation& o = m.observations[i];
    if (m.check[o.row] != 0) continue;
    const double value = residual[static_cast<Eigen::Index>(i)];
    if (model::is_rotation(o.kind)) {
      misfit.turn_rad += std::pow(value / maths::kDegPerRad, 2);
      ++turns;
    } else {
      misfit.length_mm += value * value;
      ++lengths;
    }
  }
  misfit.length_mm = lengths > 0 ? std::sqrt(misfit.length_mm / lengths) : 0;
  misfit.length_mm = std::hypot(misfit.length_mm, moved_things_mm(machine, m));
  misfit.turn_rad = turns > 0 ? std::sqrt(misfit.turn_rad / turns) : 0;
  return misfit;
}

/// Scale of a static by its effect: the value that moves its degrees of freedom by a length or an
/// angle of that size, rms over the rows. Infinite if it moves none.
Eigen::VectorXd scales_by_place(const model::Machine& machine, const model::Measurement& m, double length_mm,
                                double angle_deg) {
  std::vector<char> active(machine.statics.size(), 0);
  std::fill(active.begin(), active.end(), 1);
  model::Evaluator evaluate(machine, m.states, active);
  Eigen::VectorXd scale = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(machine.statics.size()),
                                                    std::numeric_limits<double>::infinity());
  for (const auto* branch : {&machine.tool, &machine.workpiece})
    for (const model::Transform& transform : *branch)
      for (std::size_t d = 0; d < transform.dof_count(); ++d) {
        const bool angle = transform.kind == model::TransformKind::kSixDof ? d >= 3 : d == 0 || d == 3;
        for (const auto& [key, slope] : evaluate(*transform.dof[d]).by) {
          if (key >= machine.statics.size()) continue;
          const double size = std::sqrt(slope.column(m.states.count).square().mean());
          double& least = scale[static_cast<Eigen::Index>(key)];
          if (size > 1e-12) least = std::min(least, (angle ? angle_deg : length_mm) / size);
        }
      }
  return scale;
}

/// Finds statics that tilt a travel. Their effect on a length is proportional to the position of
/// one linear axis that has a table.
void find_slopes(const model::Machine& machine, const model::Measurement& m,
                 const model::ParameterSet& parameters, Convention& convention) {
  convention.slope_of.assign(parameters.size(), -1);
  convention.slope_mm = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(parameters.size()));
  std::map<std::size_t, std::size_t> parameter_of;  // a static's
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (parameters[i].kind == model::ParameterKind::kStatic) parameter_of[parameters[i].item] = i;
  if (parameter_of.empty()) return;
  std::vector<char> active(machine.statics.size(), 0);
  for (const auto& [item, parameter] : parameter_of) active[item] = 1;
  model::Evaluator evaluate(machine, m.states, active);
  const auto take = [&](std::size_t parameter, const model::Column& slope) {
    for (std::size_t table = 0; table < machine.tables.size(); ++table) {
      const model::Column& position = m.states.axis[machine.tables[table].axis];
      if (machine.axes[machine.tables[table].axis].rotary || position.size() == 0) continue;
      const double size = position.abs().maxCoeff();
      if (size <= 0 || ((slope - position).abs().maxCoeff() > 1e-9 * size &&
                        (slope + position).abs().maxCoeff() > 1e-9 * size))
        continue;
      convention.slope_of[parameter] = static_cast<int>(table);
      convention.slope_mm[static_cast<Eigen::Index>(parameter)] =
          0.5 * (position.maxCoeff() - position.minCoeff());
    }
  };
  for (const auto* branch : {&machine.tool, &machine.workpiece})
    for (const model::Transform& transform : *branch)
      for (std::size_t d = 0; d < 3 && transform.kind == model::TransformKind::kSixDof; ++d)
        for (const auto& [key, slope] : evaluate(*transform.dof[d]).by)
          if (const auto found = parameter_of.find(key); found != parameter_of.end())
            take(found->second, slope.column(m.states.count));
}

/// Scale of a static by its unit, as a length or an angle; nullopt for any other unit.
double scale_by_unit(const std::string& unit, double length_mm, double reach_mm) {
  if (unit == "urad") return length_mm / reach_mm * 1e6;
  if (unit == "mrad") return length_mm / reach_mm * 1e3;
  const auto known = format::find_unit(unit);
  if (!known) return 0;
  if (known->dimension == format::Dimension::kLength) return length_mm / known->factor;
  if (known->dimension == format::Dimension::kAngle)
    return length_mm / reach_mm * maths::kDegPerRad / known->factor;
  return 0;
}

/// Share of a station's variance that is independent of its neighbours: a joint of a rack, a
/// ringing axis. Without it a table of 360 stations could not follow the repeating error of a real
/// circle (18 instead of 7 um, the repaired ball-bar record).
constexpr double kRough = 0.2;

/// Errors of a guideway are smooth. Their largest part is an offset, a slope or a bow, so a
/// station gives information about the next. With less than two travels of correlation, the offset
/// of an angle that only the tool's length shows was underestimated (coverage 0.89 to 0.94 instead
/// of 0.95, `reach_check`).
double expected_correlation(const model::Table& table, std::size_t a, std::size_t b) {
  const double span = table.stations.back().loc - table.stations.front().loc;
  double distance = std::abs(table.stations[a].loc - table.stations[b].loc);
  if (table.periodic) distance = std::min(distance, span - distance);
  return (1 - kRough) * std::exp(-0.5 * distance / span);
}

void correlate(const model::Machine& machine, const model::ParameterSet& parameters, Convention& convention) {
  using Entry = Eigen::Triplet<double>;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> columns;
  std::vector<Entry> together, apart;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const model::Parameter& p = parameters[i];
    if (p.kind == model::ParameterKind::kStation) {
      columns[{p.item, p.column}].push_back(i);
      continue;
    }
    together.emplace_back(static_cast<int>(i), static_cast<int>(i), 1);
    apart.emplace_back(static_cast<int>(i), static_cast<int>(i), 1);
  }
  for (const auto& [column, members] : columns) {
    const model::Table& table = machine.tables[column.first];
    const auto n = static_cast<Eigen::Index>(members.size());
    Eigen::MatrixXd k = Eigen::MatrixXd::Identity(n, n);
    for (Eigen::Index a = 0; a < n; ++a)
      for (Eigen::Index b = 0; b < a; ++b)
        k(a, b) = k(b, a) =
            expected_correlation(table, parameters[members[static_cast<std::size_t>(a)]].station,
                                 parameters[members[static_cast<std::size_t>(b)]].station);
    const Eigen::MatrixXd inverse = maths::solve_positive(k, Eigen::MatrixXd::Identity(n, n));
    for (Eigen::Index a = 0; a < n; ++a)
      for (Eigen::Index b = 0; b < n; ++b) {
        const int row = static_cast<int>(members[static_cast<std::size_t>(a)]);
        const int at = static_cast<int>(members[static_cast<std::size_t>(b)]);
        together.emplace_back(row, at, k(a, b));
        // Beyond the neighbours of a line it is 0 except for rounding.
        if (std::abs(inverse(a, b)) > 1e-12 * inverse.diagonal().maxCoeff())
          apart.emplace_back(row, at, 0.5 * (inverse(a, b) + inverse(b, a)));
      }
  }
  const auto n = static_cast<Eigen::Index>(parameters.size());
  convention.correlation.resize(n, n);
  convention.correlation.setFromTriplets(together.begin(), together.end());
  convention.precision.resize(n, n);
  convention.precision.setFromTriplets(apart.begin(), apart.end());
}

/// Noise of all readings together, in the unit of a weighted residual.
double noise_of(const model::Measurement& rows, const Convention& convention) {
  return has_uncertainty(rows) ? 1 : convention.misfit_mm;
}

/// True if even the largest plausible error of a parameter changes the readings by less than their noise.
bool is_below_noise(const SeenBesideThings& seen, const Convention& convention, Eigen::Index at,
                    double noise) {
  return std::sqrt(seen.squares[at]) * convention.most[at] < noise;
}

/// An axis that moved by less than this share of the distance of its stations did not measure its table: a
/// bed mesh moves Z by the height of the bed. The slope between two stations would follow any error of the
/// model, with this share as its lever, and the correlation would carry it along the whole axis.
constexpr double kStillShare = 0.1;

/// True for the tables whose axis hardly moved in the rows of the fit.
std::vector<char> still_tables(const model::Machine& machine, const model::Measurement& rows) {
  std::vector<char> still;
  for (const model::Table& table : machine.tables) {
    const model::Column& position = rows.states.axis[table.axis];
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (std::size_t row = 0; row < rows.rows(); ++row) {
      if (rows.check[row] != 0) continue;
      least = std::min(least, position[static_cast<Eigen::Index>(row)]);
      most = std::max(most, position[static_cast<Eigen::Index>(row)]);
    }
    double widest = 0;  // of the intervals that the positions touch
    for (std::size_t k = 1; k < table.stations.size(); ++k)
      if (table.stations[k].loc >= least && table.stations[k - 1].loc <= most)
        widest = std::max(widest, table.stations[k].loc - table.stations[k - 1].loc);
    if (widest == 0 && table.stations.size() > 1) {  // outside the table, where its end applies
      const std::size_t k = most < table.stations.front().loc ? 1 : table.stations.size() - 1;
      widest = table.stations[k].loc - table.stations[k - 1].loc;
    }
    still.push_back(most - least < kStillShare * widest ? 1 : 0);
  }
  return still;
}

/// Enlarges the scales of parameters whose effect the unknown places of touched objects absorb: an error that
/// the readings show by the share f is as large as the residual divided by f, at most kMostError. A parameter
/// is unseen if even the largest error changes the readings by less than their noise in total: what its
/// derivatives contain is the noise of the touched positions.
void enlarge_absorbed(const model::Machine& centre, const model::Measurement& rows,
                      const model::ParameterSet& parameters, double length_mm, Convention& convention) {
  if (rows.things.empty() || parameters.size() == 0) return;
  const double times = std::max(1.0, kMostError * convention.reach_mm / length_mm);
  const double noise = noise_of(rows, convention);
  const SeenBesideThings seen = seen_beside_things(centre, rows, parameters);
  convention.most =
      Eigen::VectorXd::Constant(convention.scale.size(), std::numeric_limits<double>::infinity());
  convention.unseen.assign(parameters.size(), 0);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    // Set-ups, declared scales, periods, and statics without effect on the machine have no kind.
    if (convention.kind[i] == 0 && parameters[i].kind != model::ParameterKind::kScaleFactor) continue;
    const auto at = static_cast<Eigen::Index>(i);
    convention.most[at] = times * convention.scale[at];
    convention.scale[at] =
        std::min(times * convention.scale[at], convention.scale[at] / std::max(seen.share[at], 1e-12));
    if (is_below_noise(seen, convention, at, noise)) convention.unseen[i] = 1;
  }
  const std::vector<char> still = still_tables(centre, rows);
  convention.still.assign(parameters.size(), 0);
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (parameters[i].kind == model::ParameterKind::kStation && still[parameters[i].item] != 0)
      convention.still[i] = convention.unseen[i] = 1;
}

}  // namespace

bool see_again(const model::Machine& machine, const Eigen::VectorXd& point, const model::Measurement& rows,
               const model::ParameterSet& parameters, Convention& convention) {
  if (std::find(convention.unseen.begin(), convention.unseen.end(), 1) == convention.unseen.end())
    return false;
  model::Machine fitted = machine;
  parameters.set(fitted, point);
  const SeenBesideThings seen = seen_beside_things(fitted, rows, parameters);
  bool more = false;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (convention.unseen[i] == 0 || convention.still[i] != 0 ||
        is_below_noise(seen, convention, static_cast<Eigen::Index>(i), noise_of(rows, convention)))
      continue;
    convention.unseen[i] = 0;
    more = true;
  }
  return more;
}

Eigen::SparseMatrix<double> scaled_precision(const Convention& convention, const Eigen::VectorXd& scale) {
  const Eigen::VectorXd shrink = scale.cwiseInverse();
  return shrink.asDiagonal() * convention.precision * shrink.asDiagonal();
}

Convention convention_of(const model::Machine& machine, const model::Measurement& rows,
                         const model::ParameterSet& parameters) {
  const model::Machine centre = set_up(centre_of(machine), rows);
  Convention result;
  result.reach_mm = reach_of(centre, rows);
  const Misfit misfit = misfit_of(centre, rows);
  result.misfit_mm = std::max({misfit.length_mm, misfit.turn_rad * result.reach_mm, kLeastMisfit_mm});
  const double length_mm = kTimesMisfit * result.misfit_mm;
  const double angle_deg = length_mm / result.reach_mm * maths::kDegPerRad;
  result.centre = parameters.get(centre);
  const auto n = static_cast<Eigen::Index>(parameters.size());
  result.scale.resize(n);
  result.declared.assign(parameters.size(), 0);
  result.kind.assign(parameters.size(), 0);
  result.table.assign(parameters.size(), -1);
  result.shape.assign(parameters.size(), 0);
  correlate(machine, parameters, result);
  find_slopes(centre, rows, parameters, result);
  const std::set<std::size_t> shapes = shape_statics(machine);
  result.unseen_turn = unseen_turns(centre, rows, parameters, result.reach_mm);
  Eigen::VectorXd by_place;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const model::Parameter& p = parameters[i];
    double& scale = result.scale[static_cast<Eigen::Index>(i)];
    if (model::is_set_up(p.kind)) {
      // An instrument that measures one line is aligned to that line. Only its own cosine error
      // shows the quality of the alignment.
      scale = p.column < 3 ? kAnywhere_mm : result.unseen_turn[i] ? angle_deg : kAnyTurn_deg;
      continue;
    }
    if (p.kind == model::ParameterKind::kScaleFactor) {
      scale = length_mm / result.reach_mm;
      continue;
    }
    if (p.kind == model::ParameterKind::kStation) {
      const model::Table& table = machine.tables[p.item];
      result.table[i] = static_cast<int>(p.item);
      scale = p.column < 3 ? length_mm : angle_deg;
      result.kind[i] = 1 + (p.column < 3 ? 0 : 1) + (machine.axes[table.axis].rotary ? 2 : 0);
      if (table.scale[p.column]) {
        scale = *table.scale[p.column];
        result.declared[i] = 1;
        result.kind[i] = 0;
      }
      continue;
    }
    const model::Static& item = machine.statics[p.item];
    const double nominal = std::abs(item.nominal.value_or(item.value));
    const bool shape = shapes.contains(p.item);
    result.shape[i] = shape ? 1 : 0;
    scale = shape ? nominal : scale_by_unit(item.unit, length_mm, result.reach_mm);
    if (scale > 0 && !shape) result.kind[i] = item.unit == "mm" ? kLengthStatics : kAngleStatics;
    if (scale == 0) {
      result.kind[i] = kOtherStatics;
      if (by_place.size() == 0) by_place = scales_by_place(centre, rows, length_mm, angle_deg);
      scale = by_place[static_cast<Eigen::Index>(p.item)];
      if (!std::isfinite(scale)) {
        scale = std::max(1.0, nominal);
        result.kind[i] = 0;
      }
    }
    if (item.scale) {
      scale = *item.scale;
      result.declared[i] = 1;
      result.kind[i] = 0;
    }
  }
  enlarge_absorbed(centre, rows, parameters, length_mm, result);
  return result;
}

}  // namespace vernier::fit
