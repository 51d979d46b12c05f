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

/// Writes the files that add the compensation to a working LinuxCNC configuration, besides the image: INI
/// lines (vernier.ini), a HAL file that is loaded last (vernier.hal), and instructions to install and to
/// remove them (README.md). Joints from 0 are the machine's axes in the order of its file. folder: its name
/// beside the user's INI file. Throws InputError: more than eight axes, more than 24 inputs, or a name that
/// HAL does not accept. tool.
std::vector<ConfigurationFile> linuxcnc_folder(const model::Machine& machine, const std::string& folder);

}  // namespace vernier::exchange
