// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/fit/least_squares/observability.h"
#include "tools/part/defect.h"
#include "tools/part/measured_part.h"

namespace vernier::part {

struct IdentifyOptions {
  DefectOptions defect;
  /// If true, the part was aligned to its model by best fit: six numbers of a rigid motion are fitted
  /// together with the errors (`part.X` ... `part.rZ`; mm and deg about the work origin).
  bool aligned = false;
  /// If true, the radius of the cutter is fitted too (`tool.radius`: actual - programmed, mm). A too small
  /// radius leaves material on both flanks.
  bool tool_radius = false;
};

struct IdentifiedError {
  std::string name, unit;
  double value = 0;
  std::optional<double> std;  // nullopt if the points do not determine it
};

struct Identification {
  model::Machine machine;                  // with the identified values
  std::vector<IdentifiedError> errors;     // free statics, then the alignment, then the tool's radius
  fit::Observability observability;        // over `errors`
  Eigen::MatrixXd correlation;             // over `errors`; 0 for those not determined
  Eigen::VectorXd before_mm, residual_mm;  // measured - model at the start, at the end
  double chi_square = 0, variance_factor = 1;
  Eigen::Index freedom = 0;
  int iterations = 0;
  bool converged = false;
  /// Sentences: a residual far above the points' uncertainty, and whether a tool of another radius explains
  /// it.
  std::vector<std::string> warnings;
};

/// Weighted least squares of the free statics of the machine to the measured defects. Combinations of errors
/// that the points cannot distinguish (at nominal errors) stay at their start values; `observability` names
/// these combinations. Standard uncertainties are computed as in `vernier fit`. Throws InputError if no
/// static is free or if there are fewer points than errors.
Identification identify(const BHeadMachine& machine, const MeasuredPart& part,
                        const IdentifyOptions& options = {});

/// Returns the singular values of the free statics (at their nominal values) for N points, each point with
/// standard uncertainty 1 mm.
fit::Observability part_observability(const BHeadMachine& machine, const std::vector<PartPoint>& points,
                                      const DefectOptions& options);

}  // namespace vernier::part
