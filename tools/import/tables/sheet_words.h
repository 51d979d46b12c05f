// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// The words of a heading; X_ist and X-ist are two.
std::vector<std::string> heading_words(const std::string& name);

// Meaning of a word, in small letters, for a column, in the languages of shop floors.
bool says_target(const std::string& word);
bool says_measured(const std::string& word);
/// A mean or a spread, which a spreadsheet computes from its readings: "Mittelwert".
bool says_statistic(const std::string& word);
bool says_deviation(const std::string& word);
/// The opposite of a deviation: "Korrektur", "Korrekturtabelle".
bool says_correction(const std::string& word);
/// A word of "after the correction", "without compensation": the column states no correction.
bool says_state_of_correction(const std::string& word);
/// An error across the motion ("Geradheit") or a rotation beside the motion ("Pitch"), without its direction.
bool says_straightness(const std::string& word);
bool says_tilt(const std::string& word);
/// A column that counts or names the rows: "Nr".
bool says_counting(const std::string& word);

/// True for a cell without a value: empty, "-", "n/a" …
bool is_missing(const std::string& cell);

/// 1 for forward, +, hin …; -1 for back, -, zurück …; 0: no direction.
int sense_said(std::string_view word);

/// True if a deviation is described as nominal - actual: "(nominal-actual)", "= Soll - Ist". `whole`: also
/// true if the text is only this description; "Soll-Ist-Vergleich" gives no sign.
bool says_nominal_less_actual(std::string_view text, bool whole);

/// The cells above the headings of a table.
std::vector<std::string> title_cells(const sheet::Sheet& sheet, const sheet::SheetTable& table);

/// The only axis that the titles name ("Achse: X", "X-Achse", "Axis X"); empty: no axis or several.
std::string axis_of_titles(const sheet::Sheet& sheet, const sheet::SheetTable& table);

}  // namespace vernier::importer
