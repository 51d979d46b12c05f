// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/exchange/configuration_file.h"
#include "tools/exchange/controller/placing.h"
#include "tools/exchange/controller/tables.h"

namespace vernier::exchange {

/// A controller of machine tools: SINUMERIK 840D and ONE, HEIDENHAIN (TNC 640 and others with AXISPOS),
/// FANUC (30i and others with Q1 in their parameter files).
enum class Controller : std::uint8_t { kSiemens, kHeidenhain, kFanuc };

/// Information from the user about a controller.
struct ControllerSetting {
  std::array<int, 3> number{1, 2, 3};  // number of the machine axis for X, Y and Z: AX1, A1
  double unit_um = 1;                  // detection unit of a FANUC controller
};

/// Returns the limits of a controller for its compensation tables. The sources of these limits are in
/// tools/docs/exchange.md.
ControllerRules rules_of(Controller controller, const ControllerSetting& setting);

/// Returns the compensation files for a controller. The values of `tables` are rounded in the same way as in
/// the files. Throws LimitNotMet if a value for FANUC is beyond its range. `machine_name`: name of the
/// machine for comments in the files.
std::vector<ConfigurationFile> controller_files(Controller controller, const ControllerSetting& setting,
                                                const std::string& machine_name, ControllerTables& tables);

}  // namespace vernier::exchange
