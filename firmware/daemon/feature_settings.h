// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "firmware/core/feature_inputs.h"
#include "firmware/daemon/board_file.h"

namespace vernier {

/// The inputs of kind "feature" of a board file. Throws BoardError where one names no input with samples, no
/// feature, or a window or resolution that cannot be had. setup.
std::vector<FeatureRequest> feature_requests(const BoardFile& file);

}  // namespace vernier
