// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/format/readings.h"
#include "tools/maths/moments.h"
#include "tools/residual/recorded.h"
#include "tools/residual/types.h"

namespace vernier::residual {

/// Largest number of rows that are tested; of a longer record only every n-th row is tested.
inline constexpr std::size_t kMostTestedRows = 8000;

/// The residual of one kind of observation over the fit rows, prepared for the tests.
struct KindSample {
  model::ObservationKind kind = model::ObservationKind::kX;
  std::vector<std::size_t> rows;  // in the order of the file
  Eigen::VectorXd residual;       // mm or deg
  Eigen::VectorXd weight;         // 1/u, 1 where absent
  Eigen::VectorXd held;      // weighted residual, limited to 4 robust standard deviations: input of the tests
  std::size_t outliers = 0;  // beyond 5 robust standard deviations
  std::shared_ptr<const Basis>
      basis;               // its matrix with weighted rows, columns of length 1; shared between kinds
  maths::Moments moments;  // of this kind alone, without a projection
  /// The moments after projection on the complement of the fit's Jacobian, which couples the kinds. Sum and
  /// degrees of freedom are of all kinds together, each in units of its standard deviation. If there is no
  /// Jacobian, `projected` equals `moments`.
  maths::Moments projected;

  const char* name() const { return format::name_of(kind); }
  /// Returns `held` minus the joint least-squares fit of these functions.
  Eigen::VectorXd without(const maths::FunctionSet& functions) const;
};

/// Limits values to 4 robust standard deviations and counts the values beyond 5. If more than a tenth of the
/// values are beyond 5, they are not outliers: no value is limited and 0 is returned.
std::size_t hold_outliers(Eigen::VectorXd& values);

/// Returns one sample for each kind with at least 8 fit rows and a residual that is not always zero.
std::vector<KindSample> kind_samples(const model::Measurement& measurement, const Eigen::VectorXd& residual,
                                     const std::vector<RecordedColumn>& columns,
                                     const StructureOptions& options);

/// The strongest sine over one column.
struct Period {
  double length = 0;  // in the column's unit
  maths::Explained part;
  std::size_t tried = 0;                             // number of tested frequencies
  Eigen::Vector2d factor = Eigen::Vector2d::Zero();  // of sine and cosine, weighted residual per 1
};

/// Tests sines of the column with periods from its range down to the shortest that its values allow.
/// strongest_period returns nullopt for a column with few values. residual: weighted, one per row of the
/// sample.
std::optional<Period> strongest_period(const KindSample& sample, const RecordedColumn& column,
                                       const Eigen::VectorXd& residual);

/// Correlation of the residual between the two rows of disjoint pairs.
struct PairTest {
  double correlation = 0, pairs = 0, log_p = 0;
};

/// Neighbours in the order of the rows within a run. Pairs begin with the first (phase 0) or
/// second (1) row.
PairTest serial_pairs(const KindSample& sample, const model::Measurement& measurement,
                      const Eigen::VectorXd& residual, std::size_t phase);

/// Returns separate pairs of neighbouring rows in `columns` (each scaled to its range), closest first. At
/// most 3000 rows are paired.
std::vector<std::pair<std::size_t, std::size_t>> neighbour_pairs(
    const KindSample& sample, const std::vector<const RecordedColumn*>& columns);
PairTest correlate(const Eigen::VectorXd& residual,
                   const std::vector<std::pair<std::size_t, std::size_t>>& pairs);

}  // namespace vernier::residual
