// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// Returns half the diagonal of the box around the tool points of the fit rows, mm; at least 10 mm. An angle
/// error moves the tool points by the angle times the length reach_of().
double reach_of(const model::Machine& machine, const model::Measurement& rows);

/// Returns a copy of the machine in which the free BaseShifts and ToolShifts are fitted to the fit rows. The
/// function set_up changes no other value of the machine. For complete poses with an unknown mounting, the
/// start values are computed in closed form (tools/maths/hand_eye.h). The closed form needs no start value
/// near the mounting.
model::Machine set_up(const model::Machine& machine, const model::Measurement& rows);

/// Fits the BaseShifts of the machine to all rows. The instrument may have any orientation. The start values
/// of the fit are the measuring frame, the set-up of the file, and the best rigid motion of the measured
/// points. If the residuals still exceed ten times their uncertainty, the fit starts from all 24 orientations
/// of the axes. Use set_up_anywhere for readings of a machine whose errors are known. For a survey that will
/// be fitted, use set_up(). A rotated set-up could hide swapped columns of a flat survey.
model::Machine set_up_anywhere(const model::Machine& machine, const model::Measurement& measured);

/// A measurement file, or a part of its rows, whose set-up is not in the machine file. The members are the
/// rms residuals of these rows with the set-up of the machine file, and with a separate set-up, um.
struct OtherSetUp {
  std::string file;
  std::string rows;  // "the check rows", "run 2"; empty: all rows of the file
  double before_um = 0, own_um = 0;
  /// Returns a sentence such as "other.csv: the set-up of this file is not known to the model (residual …)".
  std::string sentence() const;
};

/// Returns the files whose residual is above half a millimetre, if a separate set-up reduces this residual to
/// a twentieth or less; the check rows or one run of a file, if they alone do so. `machine`: the fitted or
/// the given machine. Check rows are included. Only length readings are used for this test of the set-up.
std::vector<OtherSetUp> files_set_up_elsewhere(const model::Machine& machine, const model::Measurement& m);

}  // namespace vernier::fit
