// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/hidden_survey_motion.h"

namespace vernier::support {

/// A column beside the axes that is no motion: thermometers, loads, an accelerometer, decoys.
struct LoggedColumn {
  enum class Sort : std::uint8_t { kTemperature, kLoad, kVibration, kDecoy };
  std::string name, unit;
  Sort sort = Sort::kDecoy;
  double reference = 0;
  std::vector<double> value;
};
std::vector<LoggedColumn> log_inputs(const std::vector<MotionRow>& rows, const MotionOptions& options,
                                     Draw& draw);

}  // namespace vernier::support
