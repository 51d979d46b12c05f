// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

namespace vernier::compile {

/// Returns the text of comp/generated/sine_table.h: sine and cosine at 512 nodes of a revolution, rounded to
/// 30 fraction bits. A test compares this text with the file. The test writes the file if
/// VERNIER_UPDATE_GOLDEN=1.
std::string print_sine_table();

}  // namespace vernier::compile
