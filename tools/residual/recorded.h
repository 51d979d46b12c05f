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
  kRun,  // label of the run; `value` is its index
  kInput,
  kNormal,
};

/// A quantity that was recorded with every row, in the form that the tests need.
struct RecordedColumn {
  std::string name, unit;
  ColumnKind kind = ColumnKind::kAxis;
  bool turns = false;   // true: a rotary axis with a range of at least half a turn
  model::Column value;  // value of every row; NaN if not recorded
};

/// Returns the columns whose values vary over the rows `rows`: axes, recorded motion, t, visit, run, inputs,
/// candidate inputs, normal. If a row touches an object, its axis positions are those on the object
/// (model::touched_positions).
std::vector<RecordedColumn> recorded_columns(const model::Machine& machine,
                                             const model::Measurement& measurement,
                                             const std::vector<std::size_t>& rows);

/// Columns of a Basis that belong together. The coefficients of columns that belong together represent one
/// statement about the residual.
struct BasisTerm {
  Shape shape = Shape::kLinear;
  std::size_t column = 0;             // index of the recorded column; kNoColumn for the constant
  std::optional<std::size_t> second;  // index of the second column of a product
  int order = 1;                      // degree of a curve
  std::vector<Eigen::Index> subject;  // columns of the matrix that are tested
  std::vector<Eigen::Index> adjust;   // columns of the matrix that are fitted first: for a product, the terms
                                      // of its two columns
};
inline constexpr std::size_t kNoColumn = static_cast<std::size_t>(-1);  // no recorded column

/// Smooth functions of the recorded columns, evaluated at some rows. The first function of the basis is the
/// constant. After the constant, each recorded column has Legendre polynomials. Directions have an odd and an
/// even part; runs have one indicator less than there are runs; rotary axes also have the first two
/// harmonics. After these functions, the basis has products of two columns. Every column of the basis matrix
/// has the length 1.
struct Basis {
  Eigen::MatrixXd matrix;        // rows x functions
  std::vector<BasisTerm> terms;  // terms that are tested, in a fixed order
};

/// Returns the basis of functions at the given rows. Products are formed for at most kMostPairs pairs of
/// columns.
Basis make_basis(const std::vector<RecordedColumn>& columns, const std::vector<std::size_t>& rows);
// The limit kMostPairs permits all pairs of 22 columns. If there are more pairs than readings, a product
// cannot be significant.
inline constexpr std::size_t kMostPairs = 250;

}  // namespace vernier::residual
