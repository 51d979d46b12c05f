// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace vernier::commands {

/// Data of a report that is handed over: company, machine, serial number, operator, instrument, date,
/// temperature and further entries.
struct ReportHeader {
  std::vector<std::string> given;  // --header "serial number=4711"
  std::string file;                // --letterhead: lines of such entries, for all reports of a shop
  std::string language;            // --language: of a built-in catalogue; empty: English
  std::string translation;         // --translation: file with another catalogue

  /// Returns the entries of the file, then those of the arguments. An entry that is given twice keeps its
  /// first position and its last text. Throws InputError with file and line, or the text of the option.
  std::vector<std::pair<std::string, std::string>> entries() const;
  /// Returns the page with the entries and the catalogue of its language, as tools/report/report.h draws
  /// them. Throws InputError for a wrong catalogue.
  nlohmann::ordered_json on(nlohmann::ordered_json page) const;
};

/// Adds --header, --letterhead, --language and --translation to a command that writes a report.
void add_report_header(CLI::App& command, ReportHeader& header);

}  // namespace vernier::commands
