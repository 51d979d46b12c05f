// SPDX-License-Identifier: GPL-3.0-or-later
// What the search for structure in a residual finds: values, no algorithm.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/model/chain/prediction.h"

namespace vernier::residual {

/// Form of the dependence of a residual on a recorded column.
enum class Shape : std::uint8_t {
  kConstant,  // the same everywhere
  kLinear,
  kSquare,    // in proportion to the square of the column's value
  kCurve,     // any other smooth curve
  kPeriodic,  // a sine of some period
  kReverses,  // odd in a direction column
  kJumps,     // a value of its own in each run
  kProduct,   // of two columns
  kWanders,   // neighbours in the order of the rows are correlated, and no column explains it
};
inline constexpr std::array<const char*, 9> kShapeNames = {
    "constant", "linear", "square", "curve", "periodic", "reverses", "jumps", "product", "wanders"};

/// A significant pattern in the residual of one kind of observation.
struct Finding {
  std::string observation;            // name of the kind of reading
  std::string column, second_column;  // second: of a product; both empty for a constant
  Shape shape = Shape::kLinear;
  double share_alone = 0;  // of the variance of this kind's residual over fit rows, 0..1, adjusted for
                           // the number of coefficients
  double share_after = 0;  // the same, beyond all other findings of this kind
  double p_value = 1;      // times the number of tests; corrected for serial correlation
  double rms_um = 0;       // of the explained part; urad for rotations
  double low_um = 0, high_um = 0;           // least and largest value of the explained curve
  std::optional<double> period;             // in the column's unit
  std::size_t runs = 0, runs_agreeing = 0;  // runs in which the effect would be visible; runs in which it is
  bool in_all_runs = false;
  std::vector<std::string>
      alike;             // other columns that explain as much, because they are correlated with this one
  std::string sentence;  // plain English, without a full stop
};

/// Share of one kind's residual that one column explains, whether it is a finding or not.
struct ColumnShare {
  std::string observation, column;
  double share_alone = 0, share_after = 0;  // after: beyond the findings that do not name this column
  double p_value = 1;                       // alone, corrected for the number of tests
};

/// Mean residual vector of the fit rows in a part of the volume, at their mean tool point in the measuring
/// frame.
struct FailureCell {
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero(), mean_um = Eigen::Vector3d::Zero();
  double noise_um = 0;  // expected length of the mean by chance alone (rms)
  std::size_t count = 0;
};

/// Description of where a model fails.
struct FailurePicture {
  std::vector<Finding> findings;    // strongest first
  std::vector<ColumnShare> shares;  // every kind x column that varies
  /// Probability that a residual without structure (independent normal errors) appears as structured as this
  /// residual. omnibus_p is one number for all columns, pairs, periods, repeats and neighbourhoods that were
  /// tested.
  double omnibus_p = 1;
  std::string omnibus_by;               // the test with the smallest p-value
  std::optional<double> chi_p;          // chi^2 against u; nullopt if u is not given for every fit row
  std::optional<double> pure_error_um;  // from rows at equal conditions; lengths only
  std::optional<double>
      lack_of_fit_um;  // rms that noise by the repeats does not explain; 0 if it explains all
  std::optional<double> lack_of_fit_p;
  std::size_t repeat_freedom = 0;
  std::optional<double> neighbour_error_um;  // without repeats: from the nearest pairs; an upper bound
  std::vector<FailureCell> cells;
  std::size_t tried = 0,
              outliers = 0;  // outliers: beyond 5 robust standard deviations, limited to 4 in the tests
};

struct StructureOptions {
  std::size_t fitted_parameters = 0;  // rank of the fit of this residual
  /// Jacobian of that fit, by observation. The Jacobian makes the tests more sensitive if many parameters
  /// were fitted. May be null.
  const model::SparseRows* jacobian = nullptr;
};

}  // namespace vernier::residual
