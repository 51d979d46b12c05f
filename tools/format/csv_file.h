// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/text/error.h"

namespace vernier::format {

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

/// Splits `text`; every row has as many fields as the header has columns. Fields may be in double quotes.
/// Throws InputError: wrong number of fields, a name that occurs twice or is not valid, an unknown unit, no
/// header.
CsvFile parse_csv(const std::string& text, const std::string& file);

}  // namespace vernier::format
