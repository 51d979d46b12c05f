// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "firmware/core/cycle/feature_inputs.h"
#include "firmware/daemon/settings/board_file.h"

namespace vernier {

/// The inputs of kind "feature" of a board file. Throws BoardError if an input names no input with samples or
/// no feature, or has a window or resolution that is not possible. Not real-time safe.
std::vector<FeatureRequest> feature_requests(const BoardFile& file);

}  // namespace vernier
