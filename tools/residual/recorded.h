// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/residual/types.h"

namespace vernier::residual {

enum class ColumnKind : std::uint8_t {
  kAxis,
  kDirection,
  kMotion,  // v, a, since, feed, curv
  kTime,
  kVisit,
  kRun,  // label; `value` is its index
  kInput,
  kNormal,
};

/// A quantity that was recorded with every row, in the form for the tests.
struct RecordedColumn {
  std::string name, unit;
  ColumnKind kind = ColumnKind::kAxis;
  bool turns = false;   // a rotary axis over at least half a turn
  model::Column value;  // of every row; NaN where not recorded
};

/// Returns the columns that vary over the rows `rows`: axes, recorded motion, t, visit, run,
/// inputs, candidate inputs, normal.
/// Positions of rows that touch an object are those on the object (model::touched_positions).
std::vector<RecordedColumn> recorded_columns(const model::Machine& machine,
                                             const model::Measurement& measurement,
                                             const std::vector<std::size_t>& rows);

/// Columns of a Basis that belong together: the coefficients of one statement about the residual.
struct BasisTerm {
  Shape shape = Shape::kLinear;
  std::size_t column = 0;             // index into the recorded columns; kNone for the constant
  std::optional<std::size_t> second;  // of a product
  int order = 1;                      // of a curve: its degree
  std::vector<Eigen::Index> subject;  // columns of the matrix
  std::vector<Eigen::Index> adjust;   // that are fitted first: a product's own two columns
};
inline constexpr std::size_t kNoColumn = static_cast<std::size_t>(-1);  // none of them

/// Smooth functions of the recorded columns on some rows. The constant is first. Then each column has
/// Legendre polynomials (directions: odd and even part; runs: one indicator less than there are runs; rotary
/// axes: the first two harmonics too). Products of pairs follow. Every column of the basis has length 1.
struct Basis {
  Eigen::MatrixXd matrix;        // rows x functions
  std::vector<BasisTerm> terms;  // the tested terms, in a fixed order
};

/// Returns the basis of some rows. At most kMostPairs pairs of columns have products.
Basis make_basis(const std::vector<RecordedColumn>& columns, const std::vector<std::size_t>& rows);
// 22 columns in pairs. More pairs than readings are not significant.
inline constexpr std::size_t kMostPairs = 250;

}  // namespace vernier::residual
