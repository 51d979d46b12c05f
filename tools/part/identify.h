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
  /// True if the part was aligned to its model by best fit. For an aligned part, six numbers of a rigid
  /// motion are fitted together with the errors (`part.X` ... `part.rZ`; mm and deg about the work origin).
  bool aligned = false;
  /// True if the radius of the cutter is fitted too (`tool.radius`: actual - programmed, mm). A cutter with a
  /// too small radius leaves material on both flanks.
  bool tool_radius = false;
};

struct IdentifiedError {
  std::string name, unit;
  double value = 0;
  std::optional<double> std;  // nullopt if the points do not determine the error
};

struct Identification {
  model::Machine machine;                  // machine with the identified values
  std::vector<IdentifiedError> errors;     // free statics, then the alignment of the part, then the radius of
                                           // the tool
  fit::Observability observability;        // observability of `errors`
  Eigen::MatrixXd correlation;             // correlation of `errors`; 0 for errors that are not determined
  Eigen::VectorXd before_mm, residual_mm;  // before_mm: measured - model at the start; residual_mm: measured
                                           // - model at the end
  double chi_square = 0, variance_factor = 1;
  Eigen::Index freedom = 0;
  int iterations = 0;
  bool converged = false;
  /// Sentences for the user: whether the residual is far above the uncertainty of the points, and whether a
  /// tool with another radius explains it.
  std::vector<std::string> warnings;
};

/// Fits the free statics of the machine to the measured defects by weighted least squares. Combinations of
/// errors that the points cannot distinguish (at nominal errors) keep their start values. `observability`
/// names these combinations. Standard uncertainties are computed as in `vernier fit`. Throws InputError if no
/// static is free or if there are fewer points than errors.
Identification identify(const BHeadMachine& machine, const MeasuredPart& part,
                        const IdentifyOptions& options = {});

/// Returns the observability (singular values) of the free statics at their nominal values, for N points that
/// each have a standard uncertainty of 1 mm.
fit::Observability part_observability(const BHeadMachine& machine, const std::vector<PartPoint>& points,
                                      const DefectOptions& options);

}  // namespace vernier::part
