// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

namespace vernier::compile {

/// The text of comp/generated/sine_table.h: sine and cosine at 512 nodes of a turn, rounded to 30 fraction
/// bits. A test compares the file with it and writes it anew with VERNIER_UPDATE_GOLDEN=1. tool.
std::string print_sine_table();

}  // namespace vernier::compile
