// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/text/error.h"

namespace vernier::format {

/// A column in the header of a measurement file: `name[unit]`.
struct CsvColumn {
  std::string name, unit;
};

/// A CSV file in the form of this project: comma as separator, comment lines beginning with `#`, one header
/// line. The fields are stored as text.
struct CsvFile {
  std::string file;
  std::size_t header_line = 0;
  std::vector<CsvColumn> columns;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::size_t> line;  // line of each row in the file, from 1
};

/// Parses the text of a CSV file. Every row must have as many fields as the header has columns. A field may
/// be in double quotes. Throws InputError for: a wrong number of fields, a column name that occurs twice or
/// is not valid, an unknown unit, a missing header.
CsvFile parse_csv(const std::string& text, const std::string& file);

}  // namespace vernier::format
