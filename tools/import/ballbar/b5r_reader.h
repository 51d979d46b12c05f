// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/import/ballbar/ballbar_file.h"

namespace vernier::importer {

/// Reads a result file (.b5r, XML) of Renishaw Ballbar 20. Indices are 0-based and END is inclusive. Throws
/// InputError with file, line and word: not XML, a missing or odd element, a view other than +A+B, indices
/// outside the readings.
BallbarFile read_b5r(const std::string& path);

}  // namespace vernier::importer
