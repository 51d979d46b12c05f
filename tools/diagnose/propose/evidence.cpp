// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/propose/evidence.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "tools/effects/input_class.h"
#include "tools/effects/probe.h"
#include "tools/effects/roles.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/fit/noise/noise_estimate.h"
#include "tools/fit/selection.h"
#include "tools/fit/solve.h"
#include "tools/format/columns.h"
#include "tools/maths/chance.h"
#include "tools/maths/decompositions.h"
#include "tools/maths/orthonormal.h"
#include "tools/maths/rounding.h"
#include "tools/model/chain/evaluate.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/chain/touched_positions.h"

namespace vernier::diagnose {
namespace {

/// Holds all free parameters. Only the probes of a machine remain free.
void hold_all(model::Machine& machine) {
  for (model::Freedom& one : model::freedoms_of(machine)) one.set_free(false);
}

/// Returns k, if every k-th row is kept so that the Jacobian has at most `most` numbers.
std::size_t stride_of(const model::Measurement& all, std::size_t parameters, double most) {
  const double numbers = static_cast<double>(all.observations.size()) * static_cast<double>(parameters + 60);
  return numbers <= most ? 1 : static_cast<std::size_t>(std::ceil(numbers / most));
}

model::Measurement thinned(const model::Measurement& all, std::size_t stride) {
  if (stride == 1) return all;
  std::vector<std::size_t> keep;
  for (std::size_t row = 0; row < all.rows(); row += stride) keep.push_back(row);
  return model::select_rows(all, keep);
}

}  // namespace

Evidence::Evidence(const model::Machine& fitted, const model::Measurement& measurement,
                   const DiagnoseThresholds& thresholds)
    : thresholds_(thresholds), machine_(fitted) {
  const model::ParameterSet parameters(fitted, fit::setups_of_fit_rows(measurement));
  const std::size_t stride = stride_of(measurement, parameters.size(), thresholds.search.most_numbers);
  stride_ = static_cast<double>(stride);
  measurement_ = thinned(measurement, stride);
  position_ = model::commanded_states(measurement_).axis;
  declared_ = fitted.inputs.size();
  noise_known_ = with_u_ = fit::has_uncertainty(measurement_);
  take_inputs();
  const Eigen::VectorXd weights = fit::fit_weights(measurement_);
  for (std::size_t i = 0; i < measurement_.observations.size(); ++i)
    if (weights[static_cast<Eigen::Index>(i)] > 0) {
      observation_.push_back(i);
      rows_.push_back(measurement_.observations[i].row);
    }
  fit_rows_ = rows_;
  std::sort(fit_rows_.begin(), fit_rows_.end());
  fit_rows_.erase(std::unique(fit_rows_.begin(), fit_rows_.end()), fit_rows_.end());
  for (const std::size_t row : rows_)
    at_fit_row_.push_back(std::lower_bound(fit_rows_.begin(), fit_rows_.end(), row) - fit_rows_.begin());
  weight_ = weights(observation_);
  layout_ = fit::noise_layout(measurement_, observation_, thresholds_.layout);
  place_ = fit::places_of_rows(measurement_, thresholds_.layout);
  respond();
  raw_residual_ = residual_;
  absorb();
  raw_absorbed_ = absorbed_;
  take_touched_positions();
  split_blocks();
}

void Evidence::take_touched_positions() {
  if (measurement_.things.empty()) return;
  const std::vector<model::Column> touched = model::touched_positions(machine_, measurement_);
  for (std::size_t axis = 0; axis < touched.size(); ++axis) {
    position_[axis] += touched[axis] - measurement_.states.axis[axis];
    recorded_.push_back(measurement_.states.axis[axis]);
    measurement_.states.axis[axis] = touched[axis];
  }
}

double Evidence::share_of_touch_error(const effects::Candidate& candidate, const std::vector<double>& scanned,
                                      const Eigen::VectorXd& k) const {
  if (recorded_.empty()) return 0;
  model::States states = measurement_.states;
  states.axis = recorded_;
  ColumnMaker maker(*this);
  const Eigen::MatrixXd change = maker.raw_at(candidate, scanned, states) - maker.raw(candidate, scanned);
  return (change * k).norm() / std::max(raw_residual_.norm(), 1e-300);
}

void Evidence::take_inputs() {
  for (const model::CandidateInput& candidate : measurement_.candidates) {
    model::Input input;
    input.name = candidate.name;
    input.unit = candidate.unit;
    machine_.inputs.push_back(input);
    model::Column column = candidate.value;
    // An empty cell gets the column's mean, which has the least influence.
    const double mean = effects::mean_of_cells(candidate);
    for (double& value : column)
      if (!std::isfinite(value)) value = mean;
    measurement_.states.input.push_back(column);
  }
  measurement_.candidates.clear();
}

Eigen::ArrayXd Evidence::at_readings(const model::Column& column) const {
  Eigen::ArrayXd values(static_cast<Eigen::Index>(rows_.size()));
  for (Eigen::Index i = 0; i < values.size(); ++i)
    values[i] = column[static_cast<Eigen::Index>(rows_[static_cast<std::size_t>(i)])];
  return values;
}

double Evidence::reference_of(std::size_t input) const {
  const model::Input& one = machine_.inputs[input];
  if (input < declared_) return one.reference;
  double sum = 0;
  for (const std::size_t row : rows_) sum += measurement_.states.input[input][static_cast<Eigen::Index>(row)];
  return effects::usual_reference(one, rows_.empty() ? 0 : sum / static_cast<double>(rows_.size()));
}

void Evidence::respond() {
  places_ = effects::all_places(machine_);
  model::Machine probed = machine_;
  hold_all(probed);
  for (const effects::DofPlace& place : places_) effects::add_probe(probed, place);
  const model::ParameterSet probes(probed, {});
  const model::HeldLinearisation held = model::linearise_held(probed, measurement_, probes);
  const model::Linearisation& linear = held.linear;
  const Eigen::MatrixXd all(linear.jacobian);
  response_.resize(static_cast<Eigen::Index>(observation_.size()), all.cols());
  residual_.resize(response_.rows());
  for (std::size_t i = 0; i < observation_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i), from = static_cast<Eigen::Index>(observation_[i]);
    response_.row(at) = weight_[at] * all.row(from);
    residual_[at] = weight_[at] * (measurement_.observations[observation_[i]].value - linear.predicted[from]);
  }
  take_things(held);
  silence_rounding();
  find_reach(linear.predicted);
}

void Evidence::take_things(const model::HeldLinearisation& held) {
  std::vector<Eigen::VectorXd> columns;
  for (Eigen::Index k = 0; k < held.by_unknown.cols(); ++k) {
    const Eigen::VectorXd all = held.by_unknown.col(k);
    const Eigen::VectorXd column = weight_.cwiseProduct(Eigen::VectorXd(all(observation_)));
    // A value that is known better than the readings tell is held.
    if (column.squaredNorm() > held.precision[k]) columns.push_back(column);
  }
  things_.resize(weight_.size(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) things_.col(static_cast<Eigen::Index>(k)) = columns[k];
}

void Evidence::silence_rounding() {
  double largest[2] = {0, 0};
  const auto kind = [&](std::size_t place) { return effects::is_angle(machine_, places_[place]) ? 1 : 0; };
  for (std::size_t i = 0; i < places_.size(); ++i)
    largest[kind(i)] = std::max(largest[kind(i)], response(i).norm());
  for (std::size_t i = 0; i < places_.size(); ++i)
    if (response(i).norm() < kRoundingOfResponse * largest[kind(i)])
      response_.col(static_cast<Eigen::Index>(i)).setZero();
}

void Evidence::find_reach(const Eigen::VectorXd& predicted) {
  // Extent of the model for each length that is read. The own length of a ball bar does not show
  // it.
  std::map<model::ObservationKind, std::pair<double, double>> ranges;
  for (const std::size_t i : observation_) {
    const model::ObservationKind kind = measurement_.observations[i].kind;
    if (model::is_rotation(kind)) continue;
    const double value = predicted[static_cast<Eigen::Index>(i)];
    auto& range = ranges.try_emplace(kind, value, value).first->second;
    range = {std::min(range.first, value), std::max(range.second, value)};
  }
  for (const auto& [kind, range] : ranges) reach_mm_ = std::hypot(reach_mm_, range.second - range.first);
  if (measurement_.things.empty()) return;
  // Readings of touches are 0: the points that were touched show the extent.
  reach_mm_ = std::max(reach_mm_, model::extent_of_points(machine_, measurement_, rows_));
}

void Evidence::absorb() {
  const model::ParameterSet parameters(machine_, fit::setups_of_fit_rows(measurement_));
  absorbed_.resize(residual_.size(), 0);
  if (parameters.size() == 0 && noise_.steps.empty() && things_.cols() == 0) return;
  const model::Linearisation linear = model::linearise_held(machine_, measurement_, parameters).linear;
  const Eigen::MatrixXd all(linear.jacobian);
  Eigen::MatrixXd jacobian(residual_.size(), all.cols());
  for (std::size_t i = 0; i < observation_.size(); ++i)
    jacobian.row(static_cast<Eigen::Index>(i)) =
        weight_[static_cast<Eigen::Index>(i)] * all.row(static_cast<Eigen::Index>(observation_[i]));
  jacobian.conservativeResize(Eigen::NoChange, all.cols() + things_.cols());
  jacobian.rightCols(things_.cols()) = things_;
  if (!noise_.steps.empty()) {
    jacobian.conservativeResize(Eigen::NoChange,
                                jacobian.cols() + static_cast<Eigen::Index>(noise_.steps.size()));
    jacobian.rightCols(static_cast<Eigen::Index>(noise_.steps.size())) =
        fit::step_columns(layout_, noise_.steps, residual_.size());
  }
  whiten(jacobian);
  Eigen::VectorXd scale = jacobian.colwise().norm();
  const double tiny = 1e-12 * std::max(scale.maxCoeff(), 1e-300);
  for (double& s : scale) s = s > tiny ? 1 / s : 0;
  jacobian *= scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(jacobian.transpose() * jacobian);
  const Eigen::VectorXd& values = eigen.eigenvalues();
  const double limit = std::pow(kAbsorbCutoff, 2) * values[values.size() - 1];
  Eigen::Index lost = 0;
  while (lost < values.size() && values[lost] <= limit) ++lost;  // all of them if no reading depends on any
  const Eigen::Index rank = std::min(values.size() - lost, residual_.size());
  if (rank == 0) return;
  const Eigen::MatrixXd seen = jacobian * (eigen.eigenvectors().rightCols(rank) *
                                           values.tail(rank).cwiseSqrt().cwiseInverse().asDiagonal());
  // A second factorisation: the eigenvectors give the weak directions with few digits.
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(seen);
  absorbed_ = qr.householderQ() * Eigen::MatrixXd::Identity(residual_.size(), rank);
  residual_ -= absorbed_ * (absorbed_.transpose() * residual_);
}

void Evidence::split_blocks() {
  std::map<std::size_t, std::vector<std::size_t>> rows_of_run;
  std::size_t total = 0;
  for (const std::size_t row : rows_) {
    auto& rows = rows_of_run[block_of(row)];
    if (!rows.empty() && rows.back() == row) continue;
    rows.push_back(row);
    ++total;
  }
  // A run that contains most rows is divided into blocks of successive rows.
  std::map<std::size_t, std::size_t> parts, first;
  std::size_t next = 0;
  for (const auto& [run, rows] : rows_of_run) {
    const FoldExtent& cut = thresholds_.search.folds;
    parts[run] = std::max<std::size_t>(1, rows.size() * cut.blocks_of_one_run / total);
    if (static_cast<double>(rows.size()) < cut.large_run * static_cast<double>(total)) parts[run] = 1;
    first[run] = next;
    next += parts[run];
  }
  block_.resize(rows_.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const std::size_t run = block_of(rows_[i]);
    const auto& rows = rows_of_run[run];
    const auto at =
        static_cast<std::size_t>(std::lower_bound(rows.begin(), rows.end(), rows_[i]) - rows.begin());
    block_[i] = static_cast<int>(first[run] + at * parts[run] / rows.size());
  }
}

std::vector<std::vector<Eigen::Index>> Evidence::readings_at_one_pose() const {
  std::map<std::pair<int, int>, std::vector<Eigen::Index>> poses;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const auto kind = static_cast<int>(measurement_.observations[observation_[i]].kind);
    poses[{kind, place_[rows_[i]]}].push_back(static_cast<Eigen::Index>(i));
  }
  std::vector<std::vector<Eigen::Index>> groups;
  for (auto& [pose, readings] : poses)
    if (readings.size() > 1) groups.push_back(std::move(readings));
  return groups;
}

double Evidence::shared_pose_error(const Eigen::VectorXd& residual, const Eigen::MatrixXd& fitted) const {
  const std::vector<std::vector<Eigen::Index>> groups = readings_at_one_pose();
  // Squares of the poses' means and of the differences within them. The fitted columns reduce
  // both.
  double between = 0, within = 0, freedom_between = 0, freedom_within = 0, count = 0;
  for (const std::vector<Eigen::Index>& readings : groups) {
    const auto n = static_cast<double>(readings.size());
    const Eigen::VectorXd part = residual(readings);
    const double mean = part.sum() * part.sum() / n;
    between += mean;
    within += part.squaredNorm() - mean;
    double taken_mean = 0, taken = 0;
    for (const Eigen::MatrixXd* basis : {&absorbed_, &fitted}) {
      const Eigen::MatrixXd rows = (*basis)(readings, Eigen::all);
      taken_mean += rows.colwise().sum().squaredNorm() / n;
      taken += rows.squaredNorm();
    }
    freedom_between += 1 - taken_mean;
    freedom_within += n - 1 - (taken - taken_mean);
    count += n;
  }
  const double least = thresholds_.evidence.pose_freedom;
  if (freedom_between < least || freedom_within < least || within <= 0) return 0;
  const double f = (between / freedom_between) / (within / freedom_within);
  if (maths::log_f_tail(f, freedom_between, freedom_within) > std::log(thresholds_.evidence.pose_chance))
    return 0;
  return (f - 1) * static_cast<double>(groups.size()) / count;
}

std::vector<std::vector<Eigen::Index>> Evidence::visits() const {
  std::map<std::pair<int, int>, std::vector<Eigen::Index>> groups;  // by kind of reading and visit
  int visit = 0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    visit += i > 0 && place_[rows_[i]] != place_[rows_[i - 1]] ? 1 : 0;
    const auto kind = static_cast<int>(measurement_.observations[observation_[i]].kind);
    groups[{kind, visit}].push_back(static_cast<Eigen::Index>(i));
  }
  std::vector<std::vector<Eigen::Index>> list;
  for (auto& [key, readings] : groups) list.push_back(std::move(readings));
  return list;
}

bool Evidence::poses_are_visits() const {
  if (!with_u_) return false;
  std::set<std::pair<int, int>> poses;  // by kind of reading
  double freedom = 0;
  const std::vector<std::vector<Eigen::Index>> all = visits();
  for (const std::vector<Eigen::Index>& readings : all) {
    const auto first = static_cast<std::size_t>(readings.front());
    poses.emplace(static_cast<int>(measurement_.observations[observation_[first]].kind),
                  place_[rows_[first]]);
    freedom += static_cast<double>(readings.size()) - 1;
  }
  // Some random positions are near each other by chance.
  const auto revisits = static_cast<double>(all.size() - poses.size());
  return revisits <= thresholds_.layout.least_revisits * static_cast<double>(all.size()) &&
         freedom >= thresholds_.evidence.pose_freedom;
}

void Evidence::weigh_poses(double share) {
  poses_ = readings_at_one_pose();
  pose_share_ = share;
  assume(noise_);
}

void Evidence::assume(const fit::NoiseModel& noise) {
  ++revision_;
  noise_ = noise;
  noise_known_ = with_u_ || !noise.independent();
  Eigen::MatrixXd residual = raw_residual_;
  share_poses(residual);
  log_determinant_ = vernier::fit::whiten(layout_, noise_, residual);
  for (const auto& readings : poses_)
    log_determinant_ += std::log(1 + static_cast<double>(readings.size()) * pose_share_);
  residual_ = residual;
  absorb();
}

fit::NoiseModel Evidence::estimate(const Eigen::MatrixXd& raw, std::vector<fit::NoiseStep> given) const {
  const auto steps = static_cast<Eigen::Index>(given.size());
  Eigen::MatrixXd residual = raw_residual_;
  Eigen::MatrixXd fitted(raw_absorbed_.rows(), steps + raw_absorbed_.cols() + raw.cols());
  fitted << fit::step_columns(layout_, given, raw_residual_.size()), raw_absorbed_, raw;
  share_poses(residual);
  share_poses(fitted);
  if (steps > 0) {
    const Eigen::VectorXd heights = maths::least_norm(fitted, Eigen::VectorXd(residual));
    for (std::size_t k = 0; k < given.size(); ++k) given[k].height = heights[static_cast<Eigen::Index>(k)];
  }
  fitted = maths::orthonormal(fitted, 1e-6, nullptr);
  residual -= fitted * (fitted.transpose() * residual);
  fit::NoiseModel noise = fit::estimate_noise(layout_, residual, fitted, with_u_, thresholds_.noise);
  if (steps == 0) return noise;
  noise.steps.insert(noise.steps.begin(), given.begin(), given.end());
  Eigen::MatrixXd all(raw.rows(), raw.cols() + steps);
  all << raw, fit::step_columns(layout_, given, raw.rows());
  noise.support += (left_in_full(raw) - left_in_full(all)) / (noise.own * noise.own);
  return noise;
}

double Evidence::left_in_full(const Eigen::MatrixXd& raw) const {
  Eigen::MatrixXd fitted(raw_absorbed_.rows(), raw_absorbed_.cols() + raw.cols());
  fitted << raw_absorbed_, raw;
  fitted = maths::orthonormal(fitted, 1e-6, nullptr);
  return (raw_residual_ - fitted * (fitted.transpose() * raw_residual_)).squaredNorm();
}

Eigen::MatrixXd Evidence::offset_columns() const {
  Eigen::MatrixXd columns =
      Eigen::MatrixXd::Zero(raw_residual_.size(), static_cast<Eigen::Index>(layout_.series.size()));
  for (std::size_t kind = 0; kind < layout_.series.size(); ++kind)
    for (const Eigen::Index reading : layout_.series[kind].reading)
      columns(reading, static_cast<Eigen::Index>(kind)) = weight_[reading];
  return columns;
}

fit::NoiseModel Evidence::noise_of_file() const {
  fit::NoiseModel noise = noise_;
  if (!noise.in_time) noise.time_constant *= stride_;
  return noise;
}

void Evidence::share_poses(Eigen::MatrixXd& columns) const {
  for (const std::vector<Eigen::Index>& readings : poses_) {
    const auto n = static_cast<double>(readings.size());
    const double taken = (1 - 1 / std::sqrt(1 + n * pose_share_)) / n;
    const Eigen::RowVectorXd shift = taken * columns(readings, Eigen::all).colwise().sum();
    for (const Eigen::Index i : readings) columns.row(i) -= shift;
  }
}

void Evidence::whiten(Eigen::MatrixXd& columns) const {
  share_poses(columns);
  if (!noise_.independent() || noise_.own != 1) vernier::fit::whiten(layout_, noise_, columns);
}

void Evidence::whiten_transposed(Eigen::MatrixXd& columns) const {
  if (!noise_.independent() || noise_.own != 1) vernier::fit::whiten_transposed(layout_, noise_, columns);
  share_poses(columns);  // a symmetric matrix
}

std::vector<int> Evidence::parts_of_runs() const {
  std::map<std::size_t, std::vector<std::size_t>> rows_of_run;
  for (const std::size_t row : rows_) {
    auto& rows = rows_of_run[block_of(row)];
    if (rows.empty() || rows.back() != row) rows.push_back(row);
  }
  std::vector<int> parts(rows_.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const auto& rows = rows_of_run[block_of(rows_[i])];
    const auto at =
        static_cast<std::size_t>(std::lower_bound(rows.begin(), rows.end(), rows_[i]) - rows.begin());
    parts[i] = static_cast<int>(at * thresholds_.search.folds.parts_of_run / rows.size());
  }
  return parts;
}

std::size_t Evidence::index_of(const effects::DofPlace& place) const {
  return static_cast<std::size_t>(std::find(places_.begin(), places_.end(), place) - places_.begin());
}

Eigen::MatrixXd Evidence::sums_by_row(std::size_t place, const Eigen::MatrixXd& columns) const {
  const auto answer = response(place);
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(fit_rows_.size()), columns.cols());
  for (Eigen::Index j = 0; j < columns.cols(); ++j)
    for (Eigen::Index i = 0; i < columns.rows(); ++i)
      sums(at_fit_row_[static_cast<std::size_t>(i)], j) += answer[i] * columns(i, j);
  return sums;
}

Eigen::MatrixXd Evidence::at_observations(const effects::Candidate& candidate,
                                          const std::vector<Eigen::MatrixXd>& of_term) const {
  Eigen::MatrixXd columns =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows_.size()), of_term.at(0).cols());
  for (std::size_t t = 0; t < of_term.size(); ++t) {
    const auto answer = response(index_of(candidate.terms[t].place));
    for (Eigen::Index j = 0; j < columns.cols(); ++j)
      for (Eigen::Index i = 0; i < columns.rows(); ++i)
        columns(i, j) += answer[i] * of_term[t](at_fit_row_[static_cast<std::size_t>(i)], j);
  }
  return columns;
}

ColumnMaker::ColumnMaker(const Evidence& evidence)
    : evidence_(evidence), scratch_(evidence.machine()), own_statics_(scratch_.statics.size()) {}

Eigen::MatrixXd ColumnMaker::raw(const effects::Candidate& candidate, const std::vector<double>& scanned) {
  return raw_at(candidate, scanned, evidence_.measurement().states);
}

std::vector<Eigen::MatrixXd> ColumnMaker::functions(const effects::Candidate& candidate,
                                                    const std::vector<double>& scanned) {
  return functions_at(candidate, scanned, evidence_.measurement().states);
}

std::vector<Eigen::MatrixXd> ColumnMaker::functions_at(const effects::Candidate& candidate,
                                                       const std::vector<double>& scanned,
                                                       const model::States& states) {
  scratch_.statics.resize(own_statics_);
  const std::vector<std::size_t> linear = effects::add_unknowns(scratch_, candidate, scanned);
  std::vector<char> active(scratch_.statics.size(), 0);
  for (const std::size_t unknown : linear) active[unknown] = 1;
  active.resize(scratch_.statics.size() + 6 * scratch_.axes.size(), 0);
  const std::vector<std::size_t>& rows = evidence_.fit_rows();
  std::vector<Eigen::MatrixXd> of_term;
  model::Evaluator evaluate(scratch_, states, active);
  for (const effects::CandidateTerm& term : candidate.terms) {
    of_term.emplace_back(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows.size()),
                                               static_cast<Eigen::Index>(linear.size())));
    const model::ValueAndSlopes dual = evaluate(*model::parse_expression_for(scratch_, term.text));
    for (const auto& [key, value] : dual.by) {
      const auto found = std::find(linear.begin(), linear.end(), key);
      if (found == linear.end()) continue;
      auto column = of_term.back().col(found - linear.begin());
      for (std::size_t i = 0; i < rows.size(); ++i) column[static_cast<Eigen::Index>(i)] = value[rows[i]];
    }
  }
  return of_term;
}

Eigen::MatrixXd ColumnMaker::raw_at(const effects::Candidate& candidate, const std::vector<double>& scanned,
                                    const model::States& states) {
  return evidence_.at_observations(candidate, functions_at(candidate, scanned, states));
}

Eigen::MatrixXd ColumnMaker::columns(const effects::Candidate& candidate,
                                     const std::vector<double>& scanned) {
  Eigen::MatrixXd result = raw(candidate, scanned);
  evidence_.whiten(result);
  return result;
}

Eigen::MatrixXd Evidence::raw_columns(const effects::Candidate& candidate,
                                      const std::vector<double>& scanned) const {
  return ColumnMaker(*this).raw(candidate, scanned);
}

Eigen::MatrixXd Evidence::columns(const effects::Candidate& candidate,
                                  const std::vector<double>& scanned) const {
  return ColumnMaker(*this).columns(candidate, scanned);
}

bool Evidence::varies(const model::Column& column) const {
  return column(rows_).maxCoeff() > column(rows_).minCoeff();
}

std::pair<double, double> Evidence::Range::outwards() const {
  const double digit = high > low ? maths::decade((high - low) / 1000) : 1;
  return {std::floor(low / digit) * digit, std::ceil(high / digit) * digit};
}

Evidence::Range Evidence::range_of(std::size_t axis) const {
  std::set<double> values;
  for (const std::size_t row : rows_) values.insert(position_[axis][static_cast<Eigen::Index>(row)]);
  Range range;
  if (values.empty()) return range;
  range.low = *values.begin();
  range.high = *values.rbegin();
  range.step = (range.high - range.low) / std::max<double>(1, static_cast<double>(values.size() - 1));
  double least = range.high - range.low;
  for (auto next = std::next(values.begin()); next != values.end(); ++next)
    least = std::min(least, *next - *std::prev(next));
  for (const double value : values) {
    const double steps = (value - range.low) / std::max(least, 1e-300);
    range.even = range.even && std::abs(steps - std::round(steps)) < thresholds_.evidence.even_step;
  }
  return range;
}

std::vector<double> Evidence::places_read(std::size_t axis, int sense, double apart) const {
  std::vector<double> all;
  for (const std::size_t row : rows_)
    if (sense == 0 || sense_of(axis, row) == sense)
      all.push_back(position_[axis][static_cast<Eigen::Index>(row)]);
  std::sort(all.begin(), all.end());
  std::vector<double> kept;
  for (const double one : all)
    if (kept.empty() || one - kept.back() > apart) kept.push_back(one);
  return kept;
}

int Evidence::sense_of(std::size_t axis, std::size_t row) const {
  const auto at = static_cast<Eigen::Index>(row);
  const model::Column& direction = measurement_.states.direction[axis];
  if (measurement_.has_recorded(format::axis_column(format::AxisQuantity::kSense, machine_.axes[axis].name)))
    return static_cast<int>(direction[at]);
  // If not recorded: the motion from the row before, across repeats at one position.
  for (Eigen::Index before = at; before-- > 0;) {
    const double step = position_[axis][at] - position_[axis][before];
    if (step != 0) return step > 0 ? 1 : -1;
  }
  return 0;
}

Evidence::Range Evidence::time_range() const {
  Range range;
  bool first = true;
  for (const std::size_t row : rows_) {
    const double t = measurement_.states.time[static_cast<Eigen::Index>(row)];
    range.low = first ? t : std::min(range.low, t);
    range.high = first ? t : std::max(range.high, t);
    first = false;
  }
  range.step = (range.high - range.low) / std::max<double>(1, static_cast<double>(measurement_.rows()) - 1);
  return range;
}

}  // namespace vernier::diagnose
