// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::simulate {

/// Computes the correction that a board added to rows that state only the active image (column
/// `corrected`). It uses the compiled directories in `directory` and below it (`vernier compile
/// -o`). It evaluates the image's own fixed-point equation at the row's commanded position: full
/// weight, its magnitude limits, no slew limit. Lags follow the rows of a run from its first one
/// on (they need the column t). An empty directory: returns an empty function, so that
/// read_measurement refuses such rows. The result throws InputError with file, line and word: no
/// such image, an axis that the machine lacks, an input of the image that is empty in the row.
/// tool.
model::ImageCorrection corrections_of_images(const std::string& directory);

/// Help text of the option `--images` that gives the directory.
inline constexpr const char* kImagesHelp =
    "directory with compiled images: what they added to rows that name one in `corrected`";

}  // namespace vernier::simulate
