// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

namespace vernier::exchange {

/// A file of the folder that an export writes. name: relative to the folder.
struct ConfigurationFile {
  std::string name, text;
};

}  // namespace vernier::exchange
