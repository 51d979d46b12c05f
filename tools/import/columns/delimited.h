// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/text/error.h"

namespace vernier::importer {

/// Text format of a table that an instrument wrote: separator, decimal sign, header.
struct DelimitedFormat {
  char separator = 0;  // ',' ';' '\t'; ' ' means one or more blanks; 0: detected from the first line
  bool decimal_comma = false;
  std::size_t skip = 0;       // number of lines at the top of the file that contain no data
  std::string comment = "#";  // lines that begin with this text are ignored; empty: no such lines
  bool header = false;        // true: the first line that is not ignored contains the names of the columns
};

/// The lines of a table, separated into fields without leading and trailing blanks. All rows have the same
/// number of fields.
struct DelimitedFile {
  std::string file;
  std::size_t header_line = 0;
  std::vector<std::string> header;  // empty if the table has no header line
  std::vector<std::vector<std::string>> rows;
  std::vector<std::size_t> line;  // line of each row in the file, from 1
};

/// Separates the text of a table into fields. A field may be in double quotes. Throws InputError with file,
/// line and word for: a row with another number of fields, an unclosed quote, a zero byte, a table without
/// rows.
DelimitedFile parse_delimited(const std::string& text, const std::string& file,
                              const DelimitedFormat& format);

/// Lines above a table that are no row of it: a title, the instrument, the date.
struct TitleLines {
  std::size_t skip = 0;            // number of lines at the top of the file, for DelimitedFormat::skip
  std::vector<std::string> texts;  // of these lines, without the empty ones and the comments
};

/// Finds the lines above the rows of a table, but for the line of its headings: the last one with as many
/// fields as most lines. Without `format.header` headings have a unit or the name of a coordinate (x, y, z).
/// Zero lines if most lines have no common number of fields, or if `format.header` finds no headings.
TitleLines title_lines(const std::string& text, const std::string& file, const DelimitedFormat& format);

/// Returns the names of the separators: comma, semicolon, tab, space, auto.
std::vector<std::string> separator_words();
/// Returns the character of a separator from its name. `place`: file and line of the name for the error
/// message; empty if the name is an argument of the command line. Throws InputError if no separator has this
/// name.
char separator_of(const std::string& name, const text::Place& place = {});

}  // namespace vernier::importer
