// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::model {

/// Text of a machine file to which measurement files added what they need: set-ups, mountings, a probe.
struct CompletedText {
  std::string text;                // text of the machine file
  std::vector<std::string> notes;  // one note for each addition
};

/// Adds one BaseShift for each measurement file after the first. If files share words, the first files that
/// share words keep the BaseShift without `setup`, and all other files get their own. The name in `setup` is
/// the file name without its ending; if two files have the same name, the folder is included. The BaseShifts
/// are necessary because the instrument has another position for each file. No BaseShift is added for a
/// measurement file that
/// - has a column `setup`, or has a run label that an earlier file has (both files then have one set-up),
/// - has only rows with role check, or only readings that need no set-up,
/// - has a BaseShift in the machine file.
/// The function adds no BaseShift if the machine file has no BaseShift without `setup`, or if this BaseShift
/// is hidden. The added BaseShifts have the start values of the BaseShift without `setup`. `text`: the text
/// of the machine file from which `machine` was read. The caller must read the rows again with the new text
/// of the machine file.
CompletedText with_set_ups_of_files(const std::string& text, const Machine& machine, const Measurement& rows);

/// Adds a ToolShift for the unknown mounting of a camera. The set-ups concerned have readings of a board (bx
/// by bz brx bry brz) and no ToolShift in the machine file. If all readings are of boards, one ToolShift
/// without `setup` is added. If not all readings are of boards, one ToolShift is added for each set-up with
/// such a camera. If the machine file has no BaseShift, one is added for the position of the board. Throws
/// InputError if other readings belong to the same set-up, because their tool is not the camera. `text` and
/// `rows` have the same meaning as for with_set_ups_of_files().
CompletedText with_camera_mountings(const std::string& text, const Machine& machine, const Measurement& rows);

}  // namespace vernier::model
