// SPDX-License-Identifier: GPL-3.0-or-later
// Data types for the result of the search for structure in a residual.
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
  kConstant,  // the same value everywhere
  kLinear,
  kSquare,    // proportional to the square of the column's value
  kCurve,     // any other smooth curve
  kPeriodic,  // a sine with some period
  kReverses,  // an odd function of a direction column
  kJumps,     // a separate value in each run
  kProduct,   // a product of two columns
  kWanders,   // neighbouring rows are correlated, and no column explains the correlation
};
inline constexpr std::array<const char*, 9> kShapeNames = {
    "constant", "linear", "square", "curve", "periodic", "reverses", "jumps", "product", "wanders"};

/// A significant pattern in the residual of one kind of observation.
struct Finding {
  std::string observation;            // name of the kind of reading
  std::string column, second_column;  // second_column: for a product; both are empty for a constant
  Shape shape = Shape::kLinear;
  double share_alone = 0;  // share of the residual's variance of this kind over the fit rows, 0..1, adjusted
                           // for the number of coefficients
  double share_after = 0;  // the same share after all other findings of this kind are fitted
  double p_value = 1;      // p-value multiplied by the number of tests; corrected for serial correlation
  double rms_um = 0;       // rms of the explained part; urad for rotations
  double low_um = 0, high_um = 0;           // smallest and largest value of the explained curve
  std::optional<double> period;             // period, in the unit of the column
  std::vector<double> parts;                // further periods of the same pattern, in the unit of the column
  std::vector<double> aliases;              // shorter periods that give the same readings at these positions
  std::size_t runs = 0, runs_agreeing = 0;  // number of runs in which the effect should be visible, and
                                            // number of runs in which the effect is visible
  bool in_all_runs = false;
  std::vector<std::string>
      alike;             // other columns that explain as much, because they are correlated with this column
  std::string sentence;  // sentence in plain English, without a full stop
};

/// Share of the residual of one kind that one column explains, also if it is not a finding.
struct ColumnShare {
  std::string observation, column;
  double share_alone = 0, share_after = 0;  // share_after: after the findings that do not contain this column
                                            // are fitted
  double p_value = 1;                       // p-value of this column alone, corrected for the number of tests
};

/// Mean residual vector of the fit rows in one part of the volume, at the mean tool point of these rows in
/// the measuring frame.
struct FailureCell {
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero(), mean_um = Eigen::Vector3d::Zero();
  double noise_um = 0;  // expected length of the mean vector if there is only noise (rms)
  std::size_t count = 0;
};

/// Description of where and how a model fails.
struct FailurePicture {
  std::vector<Finding> findings;    // strongest finding first
  std::vector<ColumnShare> shares;  // one share for each kind of reading and each column that varies
  /// Probability that a residual without structure (independent normal errors) appears to have as much
  /// structure as this residual. The value omnibus_p combines all columns, pairs, periods, repeats and
  /// neighbourhoods that were tested.
  double omnibus_p = 1;
  std::string omnibus_by;                // name of the test with the smallest p-value
  std::optional<double> chi_p;           // p-value of chi^2 relative to u; nullopt if a fit row has no u
  std::optional<double> pure_error_um;   // standard deviation from rows with equal conditions; lengths only
  std::optional<double> lack_of_fit_um;  // rms that the noise from repeats does not explain; 0 if the noise
                                         // explains the whole residual
  std::optional<double> lack_of_fit_p;
  std::size_t repeat_freedom = 0;
  std::optional<double> neighbour_error_um;  // if there are no repeats: standard deviation from the nearest
                                             // pairs, an upper limit of the noise
  std::vector<FailureCell> cells;
  std::size_t tried = 0,
              outliers = 0;  // tried: number of tests; outliers: values beyond 5 robust standard deviations,
                             // which are limited to 4 in the tests
};

struct StructureOptions {
  std::size_t fitted_parameters = 0;  // rank of the fit from which this residual comes
  /// Jacobian of the fit from which this residual comes, with one row per observation. With the Jacobian, the
  /// tests are more sensitive if many parameters were fitted. The pointer may be null.
  const model::SparseRows* jacobian = nullptr;
};

}  // namespace vernier::residual
