// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/exchange/configuration_file.h"
#include "tools/model/machine.h"

namespace vernier::exchange {

/// Returns the files that add the compensation to an existing LinuxCNC configuration. The returned files are
/// used together with the correction image. The files are INI lines (vernier.ini), a HAL file that is loaded
/// last (vernier.hal), and instructions for installation and removal (README.md). The joints of LinuxCNC
/// (numbers from 0) are the axes of the machine in the order of the machine file. `folder`: name of the
/// folder next to the user's INI file. Throws InputError if the machine has more than eight axes or 24
/// inputs, or a name that HAL does not accept.
std::vector<ConfigurationFile> linuxcnc_folder(const model::Machine& machine, const std::string& folder);

}  // namespace vernier::exchange
