// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::model {

/// A machine file in which each measurement file has its own set-up.
struct SetUpsOfFiles {
  std::string text;                // of the machine file
  std::vector<std::string> notes;  // one for each added set-up
};

/// Adds a BaseShift (`setup` = file name without its ending, with its folder for a second file of
/// one name) for each measurement file after the first. The instrument has another position for each file. No
/// BaseShift is added for a file that
/// - has a column `setup`, or has a run label that an earlier file has (one set-up as stated),
/// - has only rows with role check, or only readings that need no set-up,
/// - has a BaseShift in the machine file.
/// The function adds no BaseShift if the machine file has no BaseShift without `setup`, or if that BaseShift
/// is hidden. The start values are those of the BaseShift without `setup`. text: the text of the machine file
/// of `machine`. The rows must be read again with the new text.
SetUpsOfFiles with_set_ups_of_files(const std::string& text, const Machine& machine, const Measurement& rows);

/// Adds a ToolShift for the unknown mounting of a camera: for the set-ups that have readings of a board (bx
/// by bz brx bry brz) and no ToolShift in the machine file. If all readings are of boards, the ToolShift has
/// no `setup`; else one ToolShift is added for each of these set-ups. A BaseShift is added if the file has
/// none: it is the place of the board. Throws InputError if other readings have the same set-up: their tool
/// is not the camera. text and rows as for with_set_ups_of_files().
SetUpsOfFiles with_camera_mountings(const std::string& text, const Machine& machine, const Measurement& rows);

}  // namespace vernier::model
