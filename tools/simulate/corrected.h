// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::simulate {

/// Returns a function that computes the correction of a board for rows that state only the fingerprint of the
/// running image (column `corrected`). The images are in directories that `vernier compile -o` wrote, in
/// `directory` or below it. The function evaluates the fixed-point equation of the image at the commanded
/// position of the row, with full weight, with the magnitude limits of the image, and without a slew limit.
/// Lags are computed over the rows of a run from its first row on. Lags need the column t. Without
/// `directory` the returned function is empty, and read_measurement refuses rows that state only the
/// fingerprint of an image. The returned
/// function throws InputError with file, line and word if the image does not exist, if the machine does not
/// have an axis of the image, or if an input of the image is empty in the row.
model::ImageCorrection corrections_of_images(const std::string& directory);

/// Help text of the option `--images`, which gives the directory with the images.
inline constexpr const char* kImagesHelp =
    "directory with compiled images: what they added to rows that name one in `corrected`";

}  // namespace vernier::simulate
