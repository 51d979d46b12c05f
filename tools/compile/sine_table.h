// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

namespace vernier::compile {

/// Returns the text of comp/generated/sine_table.h: sine and cosine at 512 nodes of a revolution, rounded to
/// 30 fraction bits. A test compares the returned text with the file comp/generated/sine_table.h. If
/// VERNIER_UPDATE_GOLDEN=1, the test writes the file comp/generated/sine_table.h.
std::string print_sine_table();

}  // namespace vernier::compile
