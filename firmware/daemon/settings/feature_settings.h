// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "firmware/core/cycle/feature_inputs.h"
#include "firmware/daemon/settings/board_file.h"

namespace vernier {

/// Returns the requests for the inputs of kind "feature" in a board file. Throws BoardError if such an input
/// names no input with samples or no feature, or if its window or resolution is not possible. Not real-time
/// safe.
std::vector<FeatureRequest> feature_requests(const BoardFile& file);

}  // namespace vernier
