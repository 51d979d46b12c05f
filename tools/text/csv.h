// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/text/error.h"

namespace vernier::text {

struct FieldRules {
  char separator = ',';        // separator of the fields; a blank means blanks and tabs, where several count
                               // as one
  bool quotes_inside = false;  // true: a quote inside a field that does not begin with a quote is an ordinary
                               // character (5")
};

/// Returns the fields of one line, without leading and trailing blanks. A field may be in double quotes. Two
/// quotes in a field with quotes mean one quote. Throws InputError if a quote is not closed.
std::vector<std::string> fields_of(const std::string& line, const FieldRules& rules, const Place& place);

/// Returns a text as a CSV field. If the text contains a character with a meaning in CSV, the field is in
/// quotes.
std::string csv_cell(const std::string& text);

}  // namespace vernier::text
