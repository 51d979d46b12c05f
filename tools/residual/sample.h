// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/format/readings.h"
#include "tools/maths/moments.h"
#include "tools/residual/recorded.h"
#include "tools/residual/types.h"

namespace vernier::residual {

/// Largest number of tested rows. For a longer record, only every n-th row is tested.
inline constexpr std::size_t kMostTestedRows = 8000;

/// The residual of one kind of observation over the fit rows, prepared for the statistical tests.
struct KindSample {
  model::ObservationKind kind = model::ObservationKind::kX;
  std::vector<std::size_t> rows;  // in the order of the file
  Eigen::VectorXd residual;       // mm or deg
  Eigen::VectorXd weight;         // 1/u; 1 if u is absent
  Eigen::VectorXd held;      // weighted residual, limited to 4 robust standard deviations; the tests use this
                             // residual
  std::size_t outliers = 0;  // number of values beyond 5 robust standard deviations
  std::shared_ptr<const Basis> basis;  // basis with weighted rows and columns of length 1; several kinds may
                                       // use the same basis
  maths::Moments moments;              // moments of this kind alone, without projection
  /// The moments after projection on the complement of the fit's Jacobian, which combines all kinds of
  /// readings. The sum and the degrees of freedom are those of all kinds together, each in units of its
  /// standard deviation. If the fit has no Jacobian, the projected moments (`projected`) equal the moments
  /// of the residual (`moments`).
  maths::Moments projected;

  const char* name() const { return format::name_of(kind); }
  /// Returns `held` minus its joint least-squares fit with the given functions.
  Eigen::VectorXd without(const maths::FunctionSet& functions) const;
};

/// Limits values to 4 robust standard deviations, and returns the number of values beyond 5 robust standard
/// deviations. If more than a tenth of the values are beyond 5 robust standard deviations, they are not
/// outliers. If there are too many values beyond 5 robust standard deviations, no value is limited, and 0 is
/// returned.
std::size_t hold_outliers(Eigen::VectorXd& values);

/// Returns one sample for each kind of reading with at least 8 fit rows, if its residual is not zero
/// everywhere.
std::vector<KindSample> kind_samples(const model::Measurement& measurement, const Eigen::VectorXd& residual,
                                     const std::vector<RecordedColumn>& columns,
                                     const StructureOptions& options);

/// The strongest sine of a residual over one column.
struct Period {
  double length = 0;  // period, in the unit of the column
  maths::Explained part;
  std::size_t tried = 0;                             // number of tested frequencies
  Eigen::Vector2d factor = Eigen::Vector2d::Zero();  // coefficients of sine and cosine in the weighted
                                                     // residual
};

/// Tests sines of a column. The periods of the sines are from the range of the column down to the shortest
/// period that its values permit. The function strongest_period returns nullopt for a column with few
/// different values. `residual`: weighted residual, one value per row of the sample.
std::optional<Period> strongest_period(const KindSample& sample, const RecordedColumn& column,
                                       const Eigen::VectorXd& residual);

/// Returns the smallest and the largest value of a column over the rows of a sample.
std::pair<double, double> range_of(const KindSample& sample, const RecordedColumn& column);

/// Returns the period near `length` at which a sine explains most of the residual: the scan of
/// strongest_period has steps of a quarter of a cycle over the range of the column. At a period between two
/// steps, the sine of the step leaves a part of the pattern, which a second sine beside it would explain.
double refined_period(const KindSample& sample, const RecordedColumn& column, const Eigen::VectorXd& residual,
                      double length);

/// Correlation of the residual between the two rows of pairs without common rows.
struct PairTest {
  double correlation = 0, pairs = 0, log_p = 0;
};

/// Tests pairs of neighbouring rows within a run, in the order of the rows. `phase`: the pairs begin with the
/// first row (0) or with the second row (1).
PairTest serial_pairs(const KindSample& sample, const model::Measurement& measurement,
                      const Eigen::VectorXd& residual, std::size_t phase);

/// Returns separate pairs of rows that are neighbours in the values of `columns` (each column in units of its
/// range), closest pair first. At most 3000 rows are used for the pairs.
std::vector<std::pair<std::size_t, std::size_t>> neighbour_pairs(
    const KindSample& sample, const std::vector<const RecordedColumn*>& columns);
PairTest correlate(const Eigen::VectorXd& residual,
                   const std::vector<std::pair<std::size_t, std::size_t>>& pairs);

}  // namespace vernier::residual
