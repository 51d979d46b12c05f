// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/text/error.h"

namespace vernier::importer {

/// Format of a table that an instrument wrote: separator, decimal sign, header.
struct DelimitedFormat {
  char separator = 0;  // ',' ';' '\t'; ' ' is any run of blanks; 0: detected from the first line
  bool decimal_comma = false;
  std::size_t skip = 0;       // lines at the top that are no data
  std::string comment = "#";  // lines that begin with it are skipped; empty: no such lines
  bool header = false;        // the first line that is left names the columns
};

/// Lines of a table as fields of text, trimmed; all rows have the same number of fields.
struct DelimitedFile {
  std::string file;
  std::size_t header_line = 0;
  std::vector<std::string> header;  // empty without one
  std::vector<std::vector<std::string>> rows;
  std::vector<std::size_t> line;  // 1-based line of each row
};

/// Splits a text. Fields may be in double quotes. Throws InputError with file, line and word: a row of
/// another length, an open quote, a zero byte, no rows.
DelimitedFile parse_delimited(const std::string& text, const std::string& file,
                              const DelimitedFormat& format);

/// Returns the names of separators: comma, semicolon, tab, space, auto.
std::vector<std::string> separator_words();
/// Converts the name of a separator to its character. place: file and line of the name, for the error
/// message; empty if the name is an argument. Throws InputError.
char separator_of(const std::string& name, const text::Place& place = {});

}  // namespace vernier::importer
