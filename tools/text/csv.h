// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/text/error.h"

namespace vernier::text {

struct FieldRules {
  char separator = ',';        // a blank: blanks and tabs, several count once
  bool quotes_inside = false;  // a quote within a field that does not begin with one is a letter (5")
};

/// Returns the fields of one line, without blanks around them. A field may be in double quotes; a doubled
/// quote in it is one quote. Throws InputError.
std::vector<std::string> fields_of(const std::string& line, const FieldRules& rules, const Place& place);

/// Returns a field as CSV: in quotes if the text contains a character with a meaning in CSV.
std::string csv_cell(const std::string& text);

}  // namespace vernier::text
