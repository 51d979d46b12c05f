// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::simulate {

/// Works out what a board had added to rows that say only which image ran (column `corrected`), from the
/// compiled directories in `directory` and below it (`vernier compile -o`). The image's own fixed-point
/// equation at the row's commanded position: full weight, its magnitude limits, no slew; lags follow the rows
/// of a run from its first one on (they need the column t). An empty directory: nothing, so that
/// read_measurement refuses such rows. The result throws InputError with file, line and word: no such image,
/// an axis that the machine lacks, an input of the image that the row leaves empty. tool.
model::ImageCorrection corrections_of_images(const std::string& directory);

/// What `--help` says of the option `--images` that gives the directory.
inline constexpr const char* kImagesHelp =
    "directory with compiled images: what they added to rows that name one in `corrected`";

}  // namespace vernier::simulate
