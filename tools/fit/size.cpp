// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/size.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "tools/fit/convention.h"
#include "tools/fit/coverage/point_readings.h"
#include "tools/format/readings.h"
#include "tools/format/units.h"
#include "tools/maths/decompositions.h"
#include "tools/model/chain/prediction.h"

namespace vernier::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// If the free parameters leave more of the tool points than this share, they cannot change the size.
constexpr double kSameShape = 0.02;
/// Rows that show the direction: more add nothing but time.
constexpr std::size_t kMostRows = 300;

std::vector<std::size_t> some_fit_rows(const model::Measurement& rows) {
  std::vector<std::size_t> fitted, some;
  for (std::size_t row = 0; row < rows.rows(); ++row)
    if (rows.check[row] == 0) fitted.push_back(row);
  const std::size_t count = std::min(kMostRows, fitted.size());
  for (std::size_t k = 0; k < count; ++k) some.push_back(fitted[k * fitted.size() / count]);
  return some;
}

/// Power of a length in the unit of a parameter: 1 of mm, -1 of deg/mm, 0 of deg.
double power_of_length(const std::string& unit) {
  const auto slash = unit.find('/');
  const auto is_length = [](const std::string& word) {
    const auto known = format::find_unit(word);
    return known && known->dimension == format::Dimension::kLength;
  };
  double power = is_length(unit.substr(0, slash)) ? 1 : 0;
  if (slash != std::string::npos) power -= is_length(unit.substr(slash + 1)) ? 1 : 0;
  return power;
}

/// What a reading would do if everything became larger by the share 1, without any knowledge of a length.
double as_without_length(const model::Observation& o, double predicted) {
  return model::is_of_thing(o.kind) ? predicted : 0;
}

/// Word for the source of the size that a reading is.
std::string source_of(const model::Measurement& m, const model::Observation& o) {
  if (!model::is_of_thing(o.kind)) return format::entry_of(format::form_of(o.kind)).subject;
  const model::Artefact& artefact = m.things[m.thing[o.row]].artefact;
  if (artefact.place) return "known places";
  if (artefact.radius) return "known radius";
  return "machine";
}

/// What the word of a source is called in a sentence and in JSON.
std::string name_of_source(const std::string& word) {
  static const std::map<std::string, std::string> kNames = {{"% error", "points"},
                                                            {"length error", "lengths"},
                                                            {"deviation d", "deviations"},
                                                            {"distance error", "distances"},
                                                            {"% error of the board", "board"}};
  const auto found = kNames.find(word);
  return found == kNames.end() ? word : found->second;
}

}  // namespace

namespace {

/// How parameters and growth by the share 1 move the tool points of some fit rows, about the mean of the
/// points: 3 rows x parameters, and 3 rows; mm.
struct Growth {
  MatrixXd moves;
  VectorXd wanted;
};

Growth growth_of(const model::Machine& machine, const model::Measurement& points,
                 const model::ParameterSet& parameters) {
  const model::Linearisation linear = model::linearise(machine, points, parameters);
  Growth growth{MatrixXd(linear.jacobian), linear.predicted};
  const auto count = static_cast<Index>(points.rows());
  for (Index k = 0; k < 3; ++k) {
    const auto coordinate = Eigen::seqN(k, count, 3);
    growth.wanted(coordinate).array() -= growth.wanted(coordinate).mean();
    const MatrixXd along = growth.moves(coordinate, Eigen::all);
    growth.moves(coordinate, Eigen::all) = along.rowwise() - along.colwise().mean();
  }
  return growth;
}

model::Machine without_set_ups(model::Machine machine) {
  machine.base_shifts.clear();
  machine.tool_shifts.clear();
  return machine;
}

/// The direction that comes nearest to a growth of the whole machine. left: share of the growth that the free
/// parameters cannot make.
struct NearestDirection {
  SizeDirection direction;
  double left = 1;
  bool whole() const { return left <= kSameShape; }
};

std::optional<NearestDirection> nearest_direction(const model::Machine& machine,
                                                  const model::Measurement& rows,
                                                  const model::ParameterSet& parameters,
                                                  const Convention& convention, const VectorXd& point) {
  model::Machine there = machine;
  parameters.set(there, point);
  there = without_set_ups(std::move(there));
  const model::ParameterSet own(there, {});  // the set-ups are the last of `parameters`
  const auto n = static_cast<Index>(own.size());
  const std::vector<std::size_t> some = some_fit_rows(rows);
  if (n == 0 || some.size() < 2) return std::nullopt;
  const Growth growth = growth_of(there, point_readings(model::select_states(rows.states, some)), own);
  const MatrixXd moves = growth.moves * convention.scale.head(n).asDiagonal();
  const VectorXd share = maths::least_norm(moves, growth.wanted);
  SizeDirection direction{point, VectorXd::Zero(point.size()), VectorXd::Zero(point.size())};
  direction.at_start.head(n) = convention.scale.head(n).cwiseProduct(share);
  for (Index i = 0; i < n; ++i)
    direction.power[i] = power_of_length(parameters[static_cast<std::size_t>(i)].unit);
  return NearestDirection{direction, (growth.wanted - moves * share).norm() / growth.wanted.norm()};
}

/// Returns the names of the lengths that the fit does not change and that give the tool points their size:
/// constants, scales of linear axes, and numbers in the transforms.
std::vector<std::string> fixed_lengths(const model::Machine& machine, const model::Measurement& rows,
                                       const model::ParameterSet& parameters) {
  constexpr double kLeastOfSize = 1e-3;  // of the size of the tool points
  constexpr double kRestOfSize = 0.02;   // of that size: numbers in the transforms
  model::Machine all = without_set_ups(machine);
  for (model::Static& item : all.statics) item.hidden = false;
  for (model::Axis& axis : all.axes) axis.scale_free = !axis.rotary;
  const std::vector<std::size_t> some = some_fit_rows(rows);
  const model::Measurement points = point_readings(model::select_states(rows.states, some));
  const model::ParameterSet lengths(all, {});
  const Growth growth = growth_of(all, points, lengths);
  std::vector<Index> freed;
  for (const model::Parameter& parameter : parameters)
    for (std::size_t i = 0; i < lengths.size(); ++i)
      if (lengths[i].name == parameter.name) freed.push_back(static_cast<Index>(i));
  const MatrixXd free_moves = growth.moves(Eigen::all, freed);
  const double size_mm = growth.wanted.norm();
  const VectorXd values = lengths.get(all);
  std::vector<std::string> names;
  VectorXd left = growth.wanted;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const model::Parameter& one = lengths[i];
    const bool is_scale = one.kind == model::ParameterKind::kScaleFactor;
    const bool is_length = one.kind == model::ParameterKind::kStatic && power_of_length(one.unit) > 0;
    if (!is_scale && !is_length) continue;
    const auto at = static_cast<Index>(i);
    const VectorXd grown = (is_scale ? 1 : values[at]) * growth.moves.col(at);
    left -= grown;
    if (grown.norm() < kLeastOfSize * size_mm || std::find(freed.begin(), freed.end(), at) != freed.end())
      continue;
    // A parameter that is free may have the same effect: a scale in an expression, an offset beside an
    // offset.
    if ((grown - free_moves * maths::least_norm(free_moves, grown)).norm() < kLeastOfSize * size_mm) continue;
    names.push_back(is_scale ? "scale of " + machine.axes[one.item].name : one.name);
  }
  if (left.norm() > kRestOfSize * size_mm) names.emplace_back("numbers in the transforms");
  return names;
}

/// Largest share of the information on the size.
std::string most_of(const std::map<std::string, double>& shares) {
  const auto most = std::max_element(shares.begin(), shares.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == shares.end() || !(most->second > 0) ? "machine" : name_of_source(most->first);
}

bool reads_board(const model::Measurement& rows) {
  return std::any_of(rows.observations.begin(), rows.observations.end(), [](const model::Observation& o) {
    return format::form_of(o.kind) == format::ReadingForm::kBoard;
  });
}

}  // namespace

std::optional<SizeDirection> size_direction(const model::Machine& machine, const model::Measurement& rows,
                                            const model::ParameterSet& parameters,
                                            const Convention& convention, const VectorXd& point) {
  const auto nearest = nearest_direction(machine, rows, parameters, convention, point);
  if (!nearest || !nearest->whole()) return std::nullopt;
  return nearest->direction;
}

std::optional<SizeOfMachine> decide_size(FitProblem& problem, const model::Machine& machine,
                                         const model::ParameterSet& parameters, const Convention& convention,
                                         const StatedPriors& stated, const VectorXd& point) {
  const model::Measurement& rows = problem.measurement();
  const bool touched = !problem.things().empty();
  if ((!touched && !reads_board(rows)) || parameters.size() == 0) return std::nullopt;
  SizeOfMachine size;
  const auto nearest = nearest_direction(machine, rows, parameters, convention, point);
  model::Machine there = machine;
  parameters.set(there, point);
  if (!nearest || !nearest->whole()) size.fixed = fixed_lengths(there, rows, parameters);
  const VectorXd v = nearest ? nearest->direction.at(point) : VectorXd::Zero(point.size());
  const VectorXd dual = scaled_precision(convention, convention.scale) * v;
  // Above this share of the growth, the free parameters do not give the machine its size.
  constexpr double kMostly = 0.5;
  if (!nearest || nearest->left > kMostly) {
    size.known = true;
    size.from = "machine";
    return size;
  }
  const model::Linearisation linear = model::linearise(there, rows, parameters);
  VectorXd seen = linear.jacobian * v;
  for (std::size_t i = 0; i < rows.observations.size(); ++i) {
    const auto at = static_cast<Index>(i);
    const double alone = nearest->whole() ? as_without_length(rows.observations[i], linear.predicted[at]) : 0;
    seen[at] = problem.weights()[at] * (seen[at] - alone);
  }
  const VectorXd known = linear.known_jacobian.rows() > 0 ? VectorXd(linear.known_jacobian * v) : VectorXd();
  // Other parameters may take over a part, within their plausible sizes.
  problem.hold_size([direction = nearest->direction](const VectorXd& x) { return direction.at(x); }, dual);
  model::SparseRows others;
  problem.weighted_residuals(point, &others);
  const VectorXd unit = convention.scale;
  VectorXd answer = unit.cwiseProduct(others.transpose() * seen);
  if (known.size() > 0) answer += unit.cwiseProduct(problem.known_jacobian(point).transpose() * known);
  MatrixXd normal = unit.asDiagonal() * problem.equations(point).normal * unit.asDiagonal();
  normal.diagonal().array() += 1;
  normal.diagonal() += unit.cwiseAbs2().cwiseProduct(stated.weight);
  const double information =
      seen.squaredNorm() + known.squaredNorm() - answer.dot(maths::solve_symmetric(normal, answer));
  size.known = !nearest->whole() || !touched || information > v.dot(dual);
  size.relative_std = information > 0 ? 1 / std::sqrt(information) : 0;
  std::map<std::string, double> shares;
  for (std::size_t i = 0; i < rows.observations.size(); ++i)
    shares[source_of(rows, rows.observations[i])] += std::pow(seen[static_cast<Index>(i)], 2);
  if (size.known) {
    size.from = most_of(shares);
    problem.hold_size({}, {});
  } else {
    size.has_length = shares.size() > shares.count("machine");
    size.from = "nominal";
    size.relative_std = 1 / std::sqrt(v.dot(dual));
  }
  return size;
}

std::string size_sentence(const SizeOfMachine& size) {
  constexpr double kPartsPerMillion = 1e6;
  constexpr std::size_t kMostNames = 8;
  if (!size.known)
    return std::string(size.has_length
                           ? "The known lengths do not determine the size of the machine: it stays "
                             "at nominal. Measure a longer length, or its ends from more poses; if the "
                             "readings of the lengths have no u, state it."
                           : "No reading has a known length: the size of the machine stays at "
                             "nominal. Give the distance of two points, or an artefact with a known radius "
                             "or known positions.");
  std::string names;
  for (std::size_t i = 0; i < size.fixed.size() && i < kMostNames; ++i)
    names += (i > 0 ? ", " : "") + size.fixed[i];
  if (size.fixed.size() > kMostNames) names += fmt::format(" and {} more", size.fixed.size() - kMostNames);
  if (size.from == "machine")
    return fmt::format(
        "The size of the machine comes from lengths that the fit does not change{}: an error of 1 % in "
        "them is an error of 1 % in the size.",
        names.empty() ? "" : " (" + names + ")");
  std::string text = fmt::format("The size of the machine comes from the {}: {:.2g} um/m{}.", size.from,
                                 kPartsPerMillion * size.relative_std,
                                 size.from == "board" ? ", if the size of the board is exact" : "");
  if (!names.empty())
    text +=
        fmt::format(" Lengths that the fit does not change also limit the accuracy of the size ({}).", names);
  return text;
}

}  // namespace vernier::fit
