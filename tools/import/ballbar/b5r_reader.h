// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/import/ballbar/ballbar_file.h"

namespace vernier::importer {

/// Reads a result file (.b5r, XML) of Renishaw Ballbar 20. In a .b5r file the sample indices begin at 0, and
/// the index END belongs to the last sample of the arc. Throws InputError with file, line and word for: text
/// that is not XML, a missing or unexpected element, a view other than +A+B, indices outside the readings.
BallbarFile read_b5r(const std::string& path);

}  // namespace vernier::importer
