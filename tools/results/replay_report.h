// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "tools/model/measurement.h"
#include "tools/simulate/replay.h"

namespace vernier::results {

/// One replay of the same measurement through the loop, with the simulated path between firmware and machine.
struct ReplayStep {
  std::string label;  // "one image unit", "8 bit converter"
  simulate::ReplayResult result;
};

/// Returns the page from a measurement to a running correction: the measured errors, and the residuals on fit
/// and on check rows (improvement_report_html). Residuals are of a simpler model (`before`, may be absent),
/// of the image's model and of the 1 kHz loop.
nlohmann::ordered_json replay_report(const std::optional<model::Machine>& before,
                                     const compile::LoadedImage& image, const model::Measurement& measurement,
                                     const std::vector<ReplayStep>& steps);

}  // namespace vernier::results
