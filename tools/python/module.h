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

/// A machine file in the Python module: its text with the comments, and the machine that it describes.
struct MachineOfPython {
  std::string path, text;
  model::Machine machine;
};

/// Measurement files in the Python module, given by their names. Measurement files are read together with a
/// machine, because the machine defines the meaning of their columns.
struct MeasurementsOfPython {
  std::vector<std::string> paths;
};

/// Result of a function of the Python module: the JSON of the command with the same name, and the residuals.
struct ResultOfPython {
  nlohmann::ordered_json json;
  std::shared_ptr<const model::Measurement> measurement;
  Eigen::VectorXd residual;
  std::shared_ptr<const MachineOfPython> machine;  // the fitted machine, or the machine at the end of the
                                                   // stepwise model of a diagnosis
};

/// Reads a machine file for Python. Throws InputError under the same conditions as parse_machine.
std::shared_ptr<const MachineOfPython> machine_of_text(const std::string& path, std::string text);

/// Each function of the Python module has the result of the command with the same name. The functions of the
/// Python module throw InputError and LimitNotMet under the same conditions as the command.
ResultOfPython fit_of_python(const MachineOfPython& machine, const MeasurementsOfPython& measurements);
ResultOfPython compare_of_python(const MachineOfPython& machine, const MeasurementsOfPython& measurements);
ResultOfPython diagnose_of_python(const MachineOfPython& machine, const MeasurementsOfPython& measurements,
                                  std::size_t most);

}  // namespace vernier::python
