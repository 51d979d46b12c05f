// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"

namespace vernier::fit {

/// Where each parameter stays if the data say nothing of it, and how far from there it may plausibly be. This
/// is the convention that makes a fit's answer unique: of all machines that the data cannot tell apart, the
/// one nearest to nominal in these units.
struct Convention {
  /// Kinds below it are of tables; from it on, of statics.
  static constexpr int kFirstOfStatics = 5;
  /// What the nominal machine, set up as well as it can be, leaves of the readings: rms, mm. A machine whose
  /// errors are larger than what was seen of them altogether is not plausible.
  double misfit_mm = 0;
  /// Half the diagonal of the box of the measured points, mm: an angle moves them by that much.
  double reach_mm = 0;
  Eigen::VectorXd centre, scale;  // in the parameters' units
  /// How the values are expected to go together, in units of their scales: neighbours of a table's column
  /// do (0.8 exp(-distance / 2 travels)), others do not. And its inverse.
  Eigen::SparseMatrix<double> correlation, precision;
  std::vector<char> declared;  // the scale is the machine file's own
  std::vector<char> shape;     // a period, a time constant: what stands in a divisor, exponent or lag
  /// Parameters of one kind share what is known of their size, which the fit lowers to what it sees of those
  /// that the data determine: 0 none, else the kind.
  std::vector<int> kind;
  std::vector<int> table;  // which table an entry belongs to; -1: none
  /// Statics that are a slope of an axis' straightness (squareness: k*Z in X): that axis' table, else -1, and
  /// the length at half its travel for one unit, mm.
  std::vector<int> slope_of;
  Eigen::VectorXd slope_mm;
};

/// precision for these scales: (scale_i scale_j)^-1 precision_ij.
Eigen::SparseMatrix<double> scaled_precision(const Convention& convention, const Eigen::VectorXd& scale);

/// Scales by kind: lengths 3 x misfit, angles as much over the reach, set-ups free (rigid motion is theirs),
/// periods and time constants (what stands in a divisor, an exponent or a lag) their own nominal value,
/// coefficients of any other unit what moves their degree of freedom by as much. `scale` of the machine file
/// takes the place of any. Evaluated at the nominal machine: the same whatever the start. tool.
Convention convention_of(const model::Machine& machine, const model::Measurement& rows,
                         const model::ParameterSet& parameters);

}  // namespace vernier::fit
