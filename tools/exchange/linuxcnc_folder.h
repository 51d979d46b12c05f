// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/exchange/configuration_file.h"
#include "tools/model/machine.h"

namespace vernier::exchange {

/// Returns the files that add the compensation to a working LinuxCNC configuration, in addition to the
/// correction image. Files: INI lines (vernier.ini), a HAL file that is loaded last (vernier.hal), and
/// instructions to install and remove them (README.md). The joints, from 0, are the axes of the machine in
/// the order of its file. folder: its name beside the user's INI file. Throws InputError: more than eight
/// axes, more than 24 inputs, or a name that HAL does not accept.
std::vector<ConfigurationFile> linuxcnc_folder(const model::Machine& machine, const std::string& folder);

}  // namespace vernier::exchange
