// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/text/error.h"

namespace vernier::text {

struct FieldRules {
  char separator = ',';  // a blank: blanks and tabs, several count as one
  bool quotes_inside =
      false;  // a quote inside a field without a quote at its start is a normal character (5")
};

/// Returns the fields of one line, without surrounding blanks. A field may be in double quotes. A
/// doubled quote in it is one quote. Throws InputError. tool.
std::vector<std::string> fields_of(const std::string& line, const FieldRules& rules, const Place& place);

/// Returns a field as it is written. It is quoted if it contains characters that a reader could
/// interpret. tool.
std::string csv_cell(const std::string& text);

}  // namespace vernier::text
