// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::effects {

/// A machine file and the measurement files that were read for it. Each file has its own set-up, and the
/// machine has the transform of an offset probe and the mounting of a camera if the rows need them
/// (with_probe_offset, model::with_set_ups_of_files, model::with_camera_mountings).
struct CompletedSurvey {
  std::string text;  // text of the machine file with the additions
  model::Machine machine;
  model::Measurement rows;
  std::vector<std::string> notes;  // one note for each addition, and for each file without directions
};

/// Function that changes the machine each time after its file is read; may be empty.
using PrepareMachine = std::function<model::Machine(model::Machine)>;

/// `text`: text of the machine file `file`; `measurements`: paths of the measurement files; `images`: as for
/// model::read_measurement(). Throws InputError if a file is not valid.
CompletedSurvey complete_survey(const std::string& text, const std::string& file,
                                const std::vector<std::string>& measurements,
                                const model::ImageCorrection& images = {},
                                const PrepareMachine& prepare = {});

}  // namespace vernier::effects
