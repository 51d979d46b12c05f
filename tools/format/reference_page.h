// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

namespace vernier::format {

/// Returns the text of the page tools/docs/measurement_columns.md: every column, kind of reading, unit and
/// reserved name, from the tables of tools/format.
std::string reference_page();

}  // namespace vernier::format
