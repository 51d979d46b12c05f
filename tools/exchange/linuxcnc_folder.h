// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"

namespace vernier::exchange {

/// A text file of a configuration folder.
struct ConfigurationFile {
  std::string name, text;
};

/// What turns a LinuxCNC configuration that works into one of the compensated machine, beside the image: INI
/// lines (vernier.ini), a HAL file that is loaded last (vernier.hal), and how to put both in and take them
/// out again (README.md). Joints from 0 are the machine's axes in the order of its file. folder: its name
/// beside the user's INI file. Throws InputError: more than eight axes, or more than 24 inputs, or a name
/// that HAL does not take. tool.
std::vector<ConfigurationFile> linuxcnc_folder(const model::Machine& machine, const std::string& folder);

}  // namespace vernier::exchange
