// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// Returns half the diagonal of the box of the fit rows' tool points, mm, at least 10. An angle moves the
/// points by the lever reach_of().
double reach_of(const model::Machine& machine, const model::Measurement& rows);

/// Returns the machine with its free BaseShifts and ToolShifts fitted to the fit rows. The function changes
/// no other value of the machine. For complete poses with an unknown mounting the start is computed in closed
/// form (tools/maths/hand_eye.h), so that no value near the mounting is needed.
model::Machine set_up(const model::Machine& machine, const model::Measurement& rows);

/// Fits the BaseShifts of the machine to all rows, for any orientation of the instrument. Start values are
/// the measuring frame, the set-up of the file, and the best rigid motion of the measured points. If the
/// residuals still exceed ten times their uncertainty, all 24 orientations of the axes are tried. Use
/// set_up_anywhere for readings of a machine whose errors are known. A survey that will be fitted uses
/// set_up(), because a rotated set-up can hide swapped columns of a flat survey.
model::Machine set_up_anywhere(const model::Machine& machine, const model::Measurement& measured);

/// A measurement file whose set-up is not in the machine file: the residual of its rows with the set-up of
/// the machine file, and with a separate set-up, um.
struct OtherSetUp {
  std::string file;
  double before_um = 0, own_um = 0;
  /// "other.csv: the set-up of this file is not known to the model (residual …)".
  std::string sentence() const;
};

/// Returns the files whose residual is above half a millimetre, and decreases to a twentieth or less with a
/// separate set-up. machine: the fitted or given machine; check rows count as well. Lengths only.
std::vector<OtherSetUp> files_set_up_elsewhere(const model::Machine& machine, const model::Measurement& m);

}  // namespace vernier::fit
