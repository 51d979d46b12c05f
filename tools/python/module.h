// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::python {

/// A machine file for Python: its text with the remarks, and the machine that it describes.
struct MachineOfPython {
  std::string path, text;
  model::Machine machine;
};

/// Measurement files by their names. A machine gives their columns a meaning, so they are read together with
/// a machine.
struct MeasurementsOfPython {
  std::vector<std::string> paths;
};

/// Result of a call: the JSON of the command of the same name, and the residuals.
struct ResultOfPython {
  nlohmann::ordered_json json;
  std::shared_ptr<const model::Measurement> measurement;
  Eigen::VectorXd residual;
  std::shared_ptr<const MachineOfPython> machine;  // as fitted, or as the ladder of a diagnosis ends
};

/// Throws InputError as parse_machine does.
std::shared_ptr<const MachineOfPython> machine_of_text(const std::string& path, std::string text);

/// Each function of the module does what the command of the same name does. Throw InputError and LimitNotMet
/// as the command does.
ResultOfPython fit_of_python(const MachineOfPython& machine, const MeasurementsOfPython& measurements);
ResultOfPython compare_of_python(const MachineOfPython& machine, const MeasurementsOfPython& measurements);
ResultOfPython diagnose_of_python(const MachineOfPython& machine, const MeasurementsOfPython& measurements,
                                  std::size_t most);

}  // namespace vernier::python
