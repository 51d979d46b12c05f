// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/size.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

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
                                                            {"distance error", "distances"}};
  const auto found = kNames.find(word);
  return found == kNames.end() ? word : found->second;
}

}  // namespace

std::optional<SizeDirection> size_direction(const model::Machine& machine, const model::Measurement& rows,
                                            const model::ParameterSet& parameters,
                                            const Convention& convention, const VectorXd& point) {
  model::Machine there = machine;
  parameters.set(there, point);
  there.base_shifts.clear();
  there.tool_shifts.clear();
  const model::ParameterSet own(there, {});  // the set-ups are the last of `parameters`
  const auto n = static_cast<Index>(own.size());
  const std::vector<std::size_t> some = some_fit_rows(rows);
  if (n == 0 || some.size() < 2) return std::nullopt;
  const model::Measurement points = point_readings(model::select_states(rows.states, some));
  const model::Linearisation linear = model::linearise(there, points, own);
  MatrixXd moves = MatrixXd(linear.jacobian) * convention.scale.head(n).asDiagonal();
  VectorXd wanted = linear.predicted;
  for (Index k = 0; k < 3; ++k) {  // about any place
    const auto coordinate = Eigen::seqN(k, static_cast<Index>(some.size()), 3);
    wanted(coordinate).array() -= wanted(coordinate).mean();
    const MatrixXd along = moves(coordinate, Eigen::all);
    moves(coordinate, Eigen::all) = along.rowwise() - along.colwise().mean();
  }
  const VectorXd share = maths::least_norm(moves, wanted);
  if ((wanted - moves * share).norm() > kSameShape * wanted.norm()) return std::nullopt;
  SizeDirection direction{point, VectorXd::Zero(point.size()), VectorXd::Zero(point.size())};
  direction.at_start.head(n) = convention.scale.head(n).cwiseProduct(share);
  for (Index i = 0; i < n; ++i)
    direction.power[i] = power_of_length(parameters[static_cast<std::size_t>(i)].unit);
  return direction;
}

std::optional<SizeOfMachine> decide_size(FitProblem& problem, const model::Machine& machine,
                                         const model::ParameterSet& parameters, const Convention& convention,
                                         const VectorXd& point) {
  const model::Measurement& rows = problem.measurement();
  if (problem.things().empty() || parameters.size() == 0) return std::nullopt;
  SizeOfMachine size;
  const auto direction = size_direction(machine, rows, parameters, convention, point);
  if (!direction) {
    size.known = true;
    size.from = "machine";
    return size;
  }
  const VectorXd v = direction->at(point);
  const Eigen::SparseMatrix<double> precision = scaled_precision(convention, convention.scale);
  const VectorXd dual = precision * v;
  model::Machine there = machine;
  parameters.set(there, point);
  const model::Linearisation linear = model::linearise(there, rows, parameters);
  VectorXd seen = linear.jacobian * v;
  for (std::size_t i = 0; i < rows.observations.size(); ++i) {
    const auto at = static_cast<Index>(i);
    seen[at] =
        problem.weights()[at] * (seen[at] - as_without_length(rows.observations[i], linear.predicted[at]));
  }
  const VectorXd known = linear.known_jacobian.rows() > 0 ? VectorXd(linear.known_jacobian * v) : VectorXd();
  // Other parameters may take over a part, within their plausible sizes.
  problem.hold_size([direction = *direction](const VectorXd& x) { return direction.at(x); }, dual);
  model::SparseRows others;
  problem.weighted_residuals(point, &others);
  const VectorXd unit = convention.scale;
  VectorXd answer = unit.cwiseProduct(others.transpose() * seen);
  if (known.size() > 0)
    answer += unit.cwiseProduct(
        (linear.known_jacobian - linear.known_jacobian * v * dual.transpose() / dual.dot(v)).transpose() *
        known);
  MatrixXd normal = unit.asDiagonal() * problem.equations(point).normal * unit.asDiagonal();
  normal.diagonal().array() += 1;
  const double information =
      seen.squaredNorm() + known.squaredNorm() - answer.dot(maths::solve_symmetric(normal, answer));
  size.known = information > v.dot(dual);
  size.relative_std = information > 0 ? 1 / std::sqrt(information) : 0;
  std::map<std::string, double> shares;
  for (std::size_t i = 0; i < rows.observations.size(); ++i)
    shares[source_of(rows, rows.observations[i])] += std::pow(seen[static_cast<Index>(i)], 2);
  const auto most = std::max_element(shares.begin(), shares.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  if (size.known) {
    size.from = name_of_source(most->first);
    problem.hold_size({}, {});
  } else {
    size.from = "nominal";
    size.relative_std = 1 / std::sqrt(v.dot(dual));
  }
  return size;
}

std::string size_sentence(const SizeOfMachine& size) {
  constexpr double kPartsPerMillion = 1e6;
  if (!size.known)
    return "No reading has a known length: the size of the machine stays at nominal. Give the distance of "
           "two "
           "points, or an artefact with a known radius or known places.";
  if (size.from == "machine")
    return "The size of the machine is given by lengths that the fit does not change (scales of linear axes, "
           "fixed parameters).";
  return fmt::format("The size of the machine comes from the {}: {:.2g} um/m.", size.from,
                     kPartsPerMillion * size.relative_std);
}

}  // namespace vernier::fit
