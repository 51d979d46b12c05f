// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace vernier::commands {

/// Header data of a report for a customer: company, machine, serial number, operator, instrument, date,
/// temperature and further entries.
struct ReportHeader {
  std::vector<std::string> given;  // entries from the option --header: "serial number=4711"
  std::string file;                // file from the option --letterhead, with such entries for all reports of
                                   // a workshop
  std::string language;            // language of a built-in translation, from the option --language; empty:
                                   // English
  std::string translation;         // file with another translation, from the option --translation

  /// Returns the entries of the file, and then the entries of the arguments. If an entry is given twice, it
  /// keeps its first position and its last text. Throws InputError with file and line, or with the text of
  /// the option, if an entry is not valid.
  std::vector<std::pair<std::string, std::string>> entries() const;
  /// Adds the header entries and the translation to the data of a report page, in the form of
  /// tools/report/report.h. Throws InputError if the translation file is not valid.
  nlohmann::ordered_json on(nlohmann::ordered_json page) const;
};

/// Adds --header, --letterhead, --language and --translation to a command that writes a report.
void add_report_header(CLI::App& command, ReportHeader& header);

}  // namespace vernier::commands
