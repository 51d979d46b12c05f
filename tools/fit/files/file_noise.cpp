// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/files/file_noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/fit/fit.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/fit/set_up.h"
#include "tools/format/columns.h"
#include "tools/maths/factors.h"
#include "tools/maths/median.h"
#include "tools/text/error.h"

namespace vernier::fit {
namespace {

/// As for repeats: below it, the uncertainty of the estimate exceeds 30 %.
constexpr double kLeastFreedom = 5;
/// Residuals beyond this many standard deviations count as this many. Of normal residuals it lowers the
/// estimate by 0.3 %.
constexpr double kFarResidual = 3;
/// Change of an estimate below which the iteration ends: a tenth of its own uncertainty with 1000 readings.
constexpr double kSettledEstimate = 0.02;
constexpr int kMostFits = 12;
/// Ratio of the estimates of two files above which the files count as those of two instruments: one weight
/// for both would give nine times the right weight to one of them.
constexpr double kOtherInstrument = 3;
/// Change of an estimate by which a machine with an additional effect counts as another model of the noise:
/// the weights of the file then change by 20 %.
constexpr double kOtherModel = 0.1;
/// Least estimate, mm or deg: below the resolution of any instrument, and not 0 for readings without
/// residual.
constexpr double kLeastEstimate = 1e-7;

bool is_of(const model::Measurement& rows, const FileNoise& noise, const model::Observation& one) {
  return rows.file[one.row] == noise.file && model::is_rotation(one.kind) == noise.rotations;
}

/// The lengths and the rotations of each file that have no u.
struct WithoutU {
  std::vector<FileNoise> list;
  bool others_have = false;  // true: other fit readings have u
};

WithoutU without_u(const model::Measurement& rows) {
  WithoutU found;
  std::vector<FileNoise>& list = found.list;
  for (const model::Observation& one : rows.observations) {
    if (rows.check[one.row] != 0) continue;
    if (model::uncertainty_of(rows, one) > 0) {
      found.others_have = true;
      continue;
    }
    if (std::any_of(list.begin(), list.end(), [&](const FileNoise& n) { return is_of(rows, n, one); }))
      continue;
    FileNoise noise;
    noise.file = rows.file[one.row];
    noise.name = rows.files[noise.file];
    noise.rotations = model::is_rotation(one.kind);
    list.push_back(std::move(noise));
  }
  for (FileNoise& noise : list) noise.beside_u = found.others_have;
  return found;
}

void write_estimate(model::Measurement& rows, const FileNoise& noise) {
  if (noise.rotations && rows.angle_uncertainty.size() == 0)
    rows.angle_uncertainty = model::Column::Zero(static_cast<Eigen::Index>(rows.rows()));
  model::Column& column = noise.rotations ? rows.angle_uncertainty : rows.uncertainty;
  for (std::size_t row = 0; row < rows.rows(); ++row)
    if (rows.file[row] == noise.file) column[static_cast<Eigen::Index>(row)] = noise.u;
}

model::Measurement fit_rows_of(const model::Measurement& rows, const FileNoise& noise) {
  std::vector<std::size_t> keep;
  for (std::size_t row = 0; row < rows.rows(); ++row)
    if (rows.file[row] == noise.file && rows.check[row] == 0) keep.push_back(row);
  return model::select_rows(rows, keep);
}

/// Residuals of the fit readings of a file, mm or deg.
std::vector<double> residuals_of(const model::Measurement& rows, const FileNoise& noise,
                                 const Eigen::VectorXd& residual) {
  std::vector<double> list;
  for (std::size_t i = 0; i < rows.observations.size(); ++i)
    if (rows.check[rows.observations[i].row] == 0 && is_of(rows, noise, rows.observations[i]))
      list.push_back(residual[static_cast<Eigen::Index>(i)]);
  return list;
}

double sum_of_squares(const std::vector<double>& residuals) {
  const double far = kFarResidual * maths::robust_spread(residuals);
  double sum = 0;
  // More than half of the residuals can be 0.
  for (const double one : residuals) sum += far > 0 ? std::min(one * one, far * far) : one * one;
  return sum;
}

/// Estimates u from residuals with the degrees of freedom of `noise`.
void take_residuals(const std::vector<double>& left, FileNoise& noise) {
  noise.u = std::max(kLeastEstimate, std::sqrt(sum_of_squares(left) / noise.freedom));
  noise.std = noise.u / std::sqrt(2 * noise.freedom);
}

/// A first value that is too large rather than too small: the residual of the given machine, with the
/// instrument placed for the file.
double first_value(const model::Machine& machine, const model::Measurement& rows, const FileNoise& noise) {
  const model::Measurement own = fit_rows_of(rows, noise);
  FileNoise alone = noise;
  alone.file = own.file.front();
  const std::vector<double> left = residuals_of(own, alone, residuals(set_up(machine, own), own));
  return std::max(kLeastEstimate, std::sqrt(sum_of_squares(left) / static_cast<double>(left.size())));
}

/// Values of touched objects that the fit estimates, shared among the readings that touch one.
double estimated_values_per_touch(const model::Measurement& rows) {
  double touches = 0;
  for (const model::Observation& one : rows.observations)
    if (rows.check[one.row] == 0 && model::is_of_thing(one.kind)) ++touches;
  if (touches == 0) return 0;
  double values = 0;
  for (const model::Thing& thing : rows.things) values += thing.in_measuring_frame() ? 0 : 3;
  return std::min(1.0, values / touches);
}

/// Takes the repeats of the file. Returns false if there are too few.
bool take_repeats(const model::Measurement& rows, FileNoise& noise) {
  const model::Measurement own = fit_rows_of(rows, noise);
  std::optional<RepeatNoise> repeats = noise_of_repeats(own, noise.rotations);
  noise.source = FileNoise::Source::kRepeats;
  if (!repeats) {
    repeats = noise_of_repeats_in_set_ups(own, noise.rotations);
    noise.source = FileNoise::Source::kRepeatsInRuns;
  }
  if (!repeats || repeats->value <= 0) {
    noise.source = FileNoise::Source::kFit;
    return false;
  }
  noise.u = repeats->value / (noise.rotations ? maths::kUradPerDeg : maths::kUmPerMm);
  noise.freedom = static_cast<double>(repeats->freedom);
  noise.std = noise.u / std::sqrt(2 * noise.freedom);
  return true;
}

const char* readings_name(const FileNoise& noise) { return noise.rotations ? "rotations" : "lengths"; }
const char* column_name(const FileNoise& noise) {
  return noise.rotations ? format::columns::kAngleUncertainty : format::columns::kUncertainty;
}
const char* unit_name_of(const FileNoise& noise) { return noise.rotations ? "arcsec" : "um"; }

[[noreturn]] void refuse_few_readings(const FileNoise& noise, std::size_t readings) {
  throw text::InputError(fmt::format(
      "{}: the {} of this file have no {}, and other readings of the survey have one. The {} reading{} of "
      "the "
      "file leave {:.2g} degrees of freedom beside the model: too few to estimate the noise ({} are "
      "necessary). "
      "State the standard uncertainty: a column {}[{}]{}",
      noise.name, readings_name(noise), column_name(noise), readings, readings == 1 ? "" : "s",
      std::max(0.0, noise.freedom), kLeastFreedom, column_name(noise), unit_name_of(noise),
      noise.rotations ? ""
                      : fmt::format(", or <instrument {}=\"...\"/> under <variables> of the machine file",
                                    column_name(noise))));
}

/// Estimates one file beside a fit. Returns the relative change; nullopt if the degrees of freedom are too
/// few.
std::optional<double> estimate_file(const model::Measurement& rows, const FitResult& fit, FileNoise& noise) {
  const std::vector<double> left = residuals_of(rows, noise, fit.residual);
  noise.freedom = 0;
  const double per_touch = estimated_values_per_touch(rows);
  for (std::size_t i = 0; i < rows.observations.size() && fit.prediction_variance.size() > 0; ++i) {
    const model::Observation& one = rows.observations[i];
    if (rows.check[one.row] != 0 || !is_of(rows, noise, one)) continue;
    const double leverage =
        fit.prediction_variance[static_cast<Eigen::Index>(i)] / (fit.variance_factor * noise.u * noise.u);
    noise.freedom += 1 - std::min(1.0, leverage) - (model::is_of_thing(one.kind) ? per_touch : 0);
  }
  if (noise.freedom < kLeastFreedom) return std::nullopt;
  const double before = noise.u;
  take_residuals(left, noise);
  return std::abs(noise.u / before - 1);
}

/// The residual of a fit of the file alone, over its degrees of freedom: what the model leaves of these
/// readings if no other reading contradicts it. mm or deg; nullopt: the fit does not show it.
std::optional<double> value_alone(const model::Machine& machine, const model::Measurement& rows,
                                  const FileNoise& noise) {
  model::Measurement own = fit_rows_of(rows, noise);
  FileNoise alone = noise;
  alone.file = own.file.front();
  // The weights of all readings are equal, and so large that no plausible value of a parameter limits the
  // fit.
  constexpr double kSmall = 1e-3;
  alone.u = std::max(kLeastEstimate, kSmall * noise.u);
  write_estimate(own, alone);
  FitOptions independent;
  independent.noise = NoiseModel{};
  const FitResult result = fit(machine, own, independent);
  const double readings = static_cast<double>(residuals_of(own, alone, result.residual).size());
  if (!result.converged || readings == 0) return std::nullopt;
  estimate_file(own, result, alone);
  alone.freedom = std::max(1.0, alone.freedom);
  take_residuals(residuals_of(own, alone, result.residual), alone);
  return alone.u;
}

/// Repeats fits and estimates until the estimates do not change. `rows` and `list` have first values. Returns
/// an entry with too few degrees of freedom for an estimate, or null.
const FileNoise* iterate_estimates(const model::Machine& machine, model::Measurement& rows,
                                   std::vector<FileNoise>& list) {
  FitOptions independent;
  independent.noise = NoiseModel{};
  double change = 1;
  for (int count = 0; count < kMostFits && change > kSettledEstimate; ++count) {
    const FitResult result = fit(machine, rows, independent);
    change = 0;
    for (FileNoise& noise : list) {
      if (noise.from_repeats()) continue;
      const std::optional<double> own = estimate_file(rows, result, noise);
      if (!own) return &noise;
      change = std::max(change, *own);
    }
    for (const FileNoise& noise : list) write_estimate(rows, noise);
  }
  for (FileNoise& noise : list) noise.open = !noise.from_repeats() && change > kSettledEstimate;
  return nullptr;
}

/// A first value that is too large can repeat itself: the weight of the file is then too small for its
/// readings to change the machine, and its errors remain in the residual. If the fit of the file alone leaves
/// much less than `list` has, the estimate begins again with that value; and if it stays there, or too few
/// degrees of freedom remain, it is the answer. Parameters as iterate_estimates().
const FileNoise* begin_again_small(const model::Machine& machine, model::Measurement& rows,
                                   std::vector<FileNoise>& list) {
  std::vector<FileNoise> small = list;
  bool any = false;
  for (FileNoise& noise : small) {
    if (noise.from_repeats()) continue;
    const std::optional<double> alone = value_alone(machine, rows, noise);
    if (!alone || noise.u < kOtherInstrument * *alone) continue;
    noise.u = *alone;
    any = true;
  }
  if (!any) return nullptr;
  model::Measurement changed = rows;
  for (const FileNoise& noise : small) write_estimate(changed, noise);
  if (const FileNoise* const few = iterate_estimates(machine, changed, small)) {
    list = small;
    return &list[static_cast<std::size_t>(few - small.data())];
  }
  list = std::move(small);
  rows = std::move(changed);
  return nullptr;
}

/// Number of fit readings of a file.
std::size_t readings_of(const model::Measurement& rows, const FileNoise& noise) {
  return static_cast<std::size_t>(std::count_if(
      rows.observations.begin(), rows.observations.end(),
      [&](const model::Observation& one) { return rows.check[one.row] == 0 && is_of(rows, noise, one); }));
}

/// True if the estimates are those of different instruments.
bool differ_clearly(const std::vector<FileNoise>& list) {
  for (const FileNoise& a : list)
    for (const FileNoise& b : list)
      if (a.rotations == b.rotations && a.u > kOtherInstrument * b.u) return true;
  return false;
}

bool all_from_repeats(const std::vector<FileNoise>& list) {
  return std::all_of(list.begin(), list.end(), [](const FileNoise& noise) { return noise.from_repeats(); });
}

}  // namespace

std::string FileNoise::sentence() const {
  constexpr const char* kSources[] = {
      "the repeated readings of the file",
      "the repeated readings in the runs of the file, beside an offset of each run",
      "the residual of the file beside the fitted model, which can contain errors of the model",
      "the residual of the file with the given machine, which contains the errors of the machine"};
  const double factor = rotations ? maths::kArcsecPerDeg : maths::kUmPerMm;
  return fmt::format(
      "{}: the {} of this file have no {}, and {}. The estimate {} = {:.3g} {} +- {:.2g} is used{}, from {} "
      "({:.0f} degrees of freedom). If you know the standard uncertainty, state it in a "
      "column "
      "{}[{}]",
      name, readings_name(*this), column_name(*this),
      beside_u ? "other readings have one" : "the readings of other files have another scatter",
      column_name(*this), u * factor, unit_name_of(*this), std * factor, open ? " (it did not converge)" : "",
      kSources[static_cast<std::size_t>(source)], freedom, column_name(*this), unit_name_of(*this));
}

std::vector<FileNoise> estimate_file_noise(const model::Machine& machine, model::Measurement& rows) {
  auto [list, others_have] = without_u(rows);
  bool repeated = false;
  for (FileNoise& noise : list) repeated = take_repeats(rows, noise) || repeated;
  // Without any u, only repeats show that the instruments differ: a residual contains the model's errors.
  if (!others_have && (list.size() < 2 || !repeated)) return {};
  for (FileNoise& noise : list)
    if (!noise.from_repeats()) noise.u = first_value(machine, rows, noise);
  model::Measurement estimated = rows;
  for (const FileNoise& noise : list) write_estimate(estimated, noise);
  const FileNoise* few = all_from_repeats(list) ? nullptr : iterate_estimates(machine, estimated, list);
  if (few == nullptr && others_have && !all_from_repeats(list))
    few = begin_again_small(machine, estimated, list);
  if (few != nullptr && others_have) refuse_few_readings(*few, readings_of(rows, *few));
  if (!others_have && (few != nullptr || !differ_clearly(list))) return {};
  rows = std::move(estimated);
  return list;
}

std::vector<FileNoise> file_noise_of_residual(model::Measurement& rows, const Eigen::VectorXd& residual) {
  auto [list, others_have] = without_u(rows);
  if (!others_have) return {};
  for (FileNoise& noise : list) {
    if (take_repeats(rows, noise)) continue;
    const std::vector<double> left = residuals_of(rows, noise, residual);
    noise.source = FileNoise::Source::kGivenMachine;
    noise.freedom = static_cast<double>(left.size());
    take_residuals(left, noise);
  }
  for (const FileNoise& noise : list) write_estimate(rows, noise);
  return list;
}

bool estimate_file_noise_again(const model::Machine& machine, model::Measurement& rows,
                               std::vector<FileNoise>& noise) {
  if (all_from_repeats(noise)) return false;
  std::vector<FileNoise> next = noise;
  model::Measurement changed = rows;
  if (iterate_estimates(machine, changed, next) != nullptr) return false;
  bool other = false;
  for (std::size_t i = 0; i < next.size(); ++i)
    other = other || std::abs(next[i].u / noise[i].u - 1) > kOtherModel;
  if (!other) return false;
  noise = std::move(next);
  rows = std::move(changed);
  return true;
}

}  // namespace vernier::fit
