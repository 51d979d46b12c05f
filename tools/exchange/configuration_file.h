// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

namespace vernier::exchange {

/// A file in the folder that an export command writes. `name`: path relative to this folder.
struct ConfigurationFile {
  std::string name, text;
};

}  // namespace vernier::exchange
