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

/// The fields of one line, without blanks around them. A field may stand in double quotes, in which a doubled
/// one is one. Throws InputError. tool.
std::vector<std::string> fields_of(const std::string& line, const FieldRules& rules, const Place& place);

/// A field as it is written: in quotes where it holds what a reader might take for more than a letter. tool.
std::string csv_cell(const std::string& text);

/// A column of a measurement file's header: `name[unit]`.
struct CsvColumn {
  std::string name, unit;
};

/// A CSV file of the project's dialect: comma, `#` comment lines, one header line, fields as text.
struct CsvFile {
  std::string file;
  std::size_t header_line = 0;
  std::vector<CsvColumn> columns;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::size_t> line;  // 1-based line of each row
};

/// Splits `text`; every row has as many fields as the header has columns. Fields may stand in double quotes.
/// Throws InputError: wrong number of fields, a name that stands twice or is no name, an unknown unit, no
/// header. tool.
CsvFile parse_csv(const std::string& text, const std::string& file);

}  // namespace vernier::text
