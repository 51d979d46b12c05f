// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/fit/types.h"
#include "tools/model/fit_record.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// Returns the discrepancy of the model: the standard deviation of errors that the model does not contain, as
/// the residual shows them. For each direction of workpiece coordinates, the discrepancy is the root of the
/// mean squared residual beyond the noise, mm. The noise is the stated u, or comes from repeats if u is
/// absent. The discrepancy is computed separately for fit rows (corrected for the part of the discrepancy
/// that the fit removes) and for check rows. The larger of the discrepancies of fit rows and check rows is
/// the result. A direction is included only if its residual is improbable by chance (a probability of at most
/// one in a thousand). A direction without readings has the mean variance of the other directions. A reading
/// belongs to the coordinate direction that is nearest to its own direction. The discrepancy is zero if the
/// noise is not known.
Eigen::Vector3d model_discrepancy(const FitResult& result, const model::Measurement& measurement);

/// Returns the findings of a fit that the machine file keeps and that every later command reports. Codes of
/// the findings: `something-missing` (value: residual over noise), `noise-unknown` (the readings have neither
/// u nor repeats), `no-gain` (check rows against the nominal machine), `disturbed` (size of a disturbance of
/// the survey, such as a step of the instrument, divided by the residual of the nominal machine),
/// `contradicting-rows` (largest distance of two points measured at one pose, um),
/// `check-not-independent` (share of the check rows at poses of fit rows), `not-varied` (number of
/// dependences), `not-distinguished` (number of alternatives), `absurd`, `not-converged`, `size-unknown` (no
/// reading has a known length; value: the plausible share), `taken-as-exact` (a length that gives the machine
/// its size, and whose own error no reading shows; value 0), `far-from-nominal` (a fit of touches gave
/// another machine than that of the file), `flatness-assumed` (a probe beside the tool point touched a
/// plane of unknown position, and no other reading determines a bow of the axes over this plane; value 0),
/// `stood-still` (number of axes that had one position in all fit rows, while others moved),
/// `outside-travel` (number of rows with a position outside the travel of its axis), `computed-positions` (an
/// arm whose readings are those of its nominal chain; value: their rms, um). `record`: the fit record,
/// complete except for the findings.
std::vector<model::FitRecord::Finding> findings_of(const FitResult& result, const model::FitRecord& record,
                                                   const model::Measurement& measurement);

/// Code of the finding that a bow of the touched plane counts as an error of the axes.
inline constexpr const char* kFlatnessAssumed = "flatness-assumed";

/// Code of the finding that the known lengths do not determine the size of the machine.
inline constexpr const char* kSizeUnknown = "size-unknown";

/// Code of the finding that an axis had one position in all fit rows.
inline constexpr const char* kStoodStill = "stood-still";

/// Code of the finding that rows have positions outside the travel of an axis.
inline constexpr const char* kOutsideTravel = "outside-travel";

/// Without a column setup each run is a set-up of its own, and then equal targets of two runs are no repeats.
/// True if the noise of the readings is unknown for this reason alone.
bool repeats_in_other_runs(const model::Measurement& measurement);
/// The explanation of this case, and what to do.
inline constexpr const char* kRepeatsInOtherRuns =
    "The rows repeat targets in other runs, but each run counts as a set-up of its own, so the noise of the "
    "readings is unknown. If the set-up did not change between the runs, add a column setup with one label "
    "(import table: --set \"setup=1\").";

}  // namespace vernier::fit
