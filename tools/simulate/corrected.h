// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::simulate {

/// Computes the correction that a board added to rows that state only the fingerprint of the running
/// correction image (column `corrected`). The images are in the compiled directories in `directory` and below
/// it (`vernier compile -o`). The function evaluates the fixed-point equation of the image at the commanded
/// position of the row: full weight, the magnitude limits of the image, no slew limit. Lags follow the rows
/// of a run from its first row on (they need the column t). If `directory` is empty, the returned function is
/// empty, and read_measurement refuses such rows. The returned function throws InputError with file, line and
/// word: an image that does not exist, an axis that the machine lacks, an input of the image that is empty in
/// the row.
model::ImageCorrection corrections_of_images(const std::string& directory);

/// Help text of the option `--images`, which gives the directory of the images.
inline constexpr const char* kImagesHelp =
    "directory with compiled images: what they added to rows that name one in `corrected`";

}  // namespace vernier::simulate
