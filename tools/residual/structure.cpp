// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/residual/structure.h"

#include <algorithm>
#include <cmath>

#include "tools/fit/least_squares/statistics.h"
#include "tools/maths/chance.h"
#include "tools/residual/cells.h"
#include "tools/residual/findings.h"
#include "tools/residual/omnibus.h"
#include "tools/residual/repeats.h"

namespace vernier::residual {
namespace {

std::vector<std::size_t> fit_rows(const model::Measurement& m) {
  std::vector<char> seen(m.rows(), 0);
  for (const model::Observation& o : m.observations) seen[o.row] = m.check[o.row] == 0 ? 1 : 0;
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < m.rows(); ++row)
    if (seen[row] != 0) rows.push_back(row);
  return rows;
}

std::optional<double> chi_tail(const model::Measurement& m, const Eigen::VectorXd& residual,
                               std::size_t parameters) {
  if (!fit::has_uncertainty(m)) return std::nullopt;
  const Eigen::VectorXd weights = fit::fit_weights(m);
  const auto readings = static_cast<double>((weights.array() > 0).count());
  const double freedom = readings - static_cast<double>(parameters);
  if (freedom <= 0) return std::nullopt;
  return maths::chi_square_tail(weights.cwiseProduct(residual).squaredNorm(), freedom);
}

/// Sorts findings, strongest first: by the variance that each removes, in units of the residual
/// variance of its own kind.
void sort_by_strength(std::vector<Finding>& findings, const std::vector<KindSample>& samples) {
  const auto strength = [&](const Finding& f) {
    for (const KindSample& sample : samples)
      if (f.observation == sample.name()) {
        const bool weighted = sample.weight.maxCoeff() > 1;
        return f.share_after * (weighted || !model::is_rotation(sample.kind) ? sample.held.squaredNorm() : 0);
      }
    return 0.0;
  };
  std::stable_sort(findings.begin(), findings.end(),
                   [&](const Finding& a, const Finding& b) { return strength(a) > strength(b); });
}

}  // namespace

FailurePicture failure_picture(const model::Machine& machine, const model::Measurement& m,
                               const Eigen::VectorXd& residual, const StructureOptions& options) {
  FailurePicture picture;
  const std::vector<std::size_t> rows = fit_rows(m);
  const std::vector<RecordedColumn> columns = recorded_columns(machine, m, rows);
  const std::vector<KindSample> samples = kind_samples(m, residual, columns, options);
  picture.chi_p = chi_tail(m, residual, options.fitted_parameters);
  if (samples.empty()) return picture;
  const Repeats repeats = compare_repeats(samples, m);
  picture.pure_error_um = repeats.pure_error_um;
  picture.lack_of_fit_um = repeats.lack_of_fit_um;
  if (repeats.log_p) picture.lack_of_fit_p = std::exp(*repeats.log_p);
  picture.repeat_freedom = repeats.freedom;
  if (!picture.pure_error_um) picture.neighbour_error_um = neighbour_error_um(samples, columns);
  const Omnibus omnibus = omnibus_test(samples, columns, m, repeats);
  picture.omnibus_p = omnibus.p;
  picture.omnibus_by = omnibus.by;
  FindingContext context{m, columns};
  context.tried = 0;
  for (const KindSample& sample : samples) {
    context.tried += count_tried(sample, columns);
    picture.outliers += sample.outliers;
  }
  picture.tried = context.tried;
  for (const KindSample& sample : samples) {
    const std::vector<Finding> found = find_structure(sample, context, picture.shares);
    picture.findings.insert(picture.findings.end(), found.begin(), found.end());
  }
  sort_by_strength(picture.findings, samples);
  picture.cells = failure_cells(machine, m, residual);
  return picture;
}

}  // namespace vernier::residual
