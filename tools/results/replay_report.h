// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "tools/model/measurement.h"
#include "tools/simulate/replay.h"

namespace vernier::results {

/// One replay of a measurement through the control loop of the board, with a simulated output between
/// firmware and machine.
struct ReplayStep {
  std::string label;  // name of the output: "one image unit", "8 bit converter"
  simulate::ReplayResult result;
};

/// Returns the data of a report from a measurement to a running correction: the measured errors, and the
/// residuals on fit rows and on check rows (improvement_report_html). The residuals are those of a simpler
/// model (`before`, may be absent), of the model in the image, and of the 1 kHz loop.
nlohmann::ordered_json replay_report(const std::optional<model::Machine>& before,
                                     const compile::LoadedImage& image, const model::Measurement& measurement,
                                     const std::vector<ReplayStep>& steps);

}  // namespace vernier::results
