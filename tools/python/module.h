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

/// A machine file: its text, which keeps remarks, and what it means.
struct MachineOfPython {
  std::string path, text;
  model::Machine machine;
};

/// Measurement files by their names; a machine gives their columns a meaning, so they are read with one.
struct MeasurementsOfPython {
  std::vector<std::string> paths;
};

/// What a call found: the JSON of the command of that name, and the residuals behind it.
struct ResultOfPython {
  nlohmann::ordered_json json;
  std::shared_ptr<const model::Measurement> measurement;
  Eigen::VectorXd residual;
  std::shared_ptr<const MachineOfPython> machine;  // as fitted, or as the ladder of a diagnosis ends
};

/// Throws InputError as parse_machine does. tool.
std::shared_ptr<const MachineOfPython> machine_of_text(const std::string& path, std::string text);

/// The calls of the module, each as the command of its name. Throw InputError and LimitNotMet as that does.
/// tool.
ResultOfPython fit_of_python(const MachineOfPython& machine, const MeasurementsOfPython& measurements);
ResultOfPython compare_of_python(const MachineOfPython& machine, const MeasurementsOfPython& measurements);
ResultOfPython diagnose_of_python(const MachineOfPython& machine, const MeasurementsOfPython& measurements,
                                  std::size_t most);

}  // namespace vernier::python
