// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/diagnose/propose/evidence.h"
#include "tools/effects/candidate.h"

namespace vernier::diagnose {

/// Name of the acceptance test: the first word of CandidateFinding::why_not.
inline constexpr const char* kTestBetweenStations = "stations";

/// The error of an axis that its table leaves between two stations. A table follows its axis at the stations,
/// and straight lines between them.
struct CurveBetweenStations {
  double spacing = 0;       // median distance of the stations in the measured range, in the unit of the axis
  Eigen::MatrixXd columns;  // one column for each pair of stations: an error that is largest in the middle
                            // between both and zero at both; whitened, in the complement of the model's
                            // free parameters
};

/// Returns the curve between the stations of the table of the candidate's axis, at the candidate's location
/// in the chain. `columns` has no columns if the axis has no table, or if the candidate has no axis and
/// location.
CurveBetweenStations curve_between_stations(const Evidence& evidence, const effects::Candidate& candidate);

}  // namespace vernier::diagnose
