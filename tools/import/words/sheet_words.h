// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Returns the words of a heading; "X_ist" and "X-ist" have two words.
std::vector<std::string> heading_words(const std::string& name);

/// Returns the words of a cell or a title in small letters, without any sign between or behind them:
/// "Mittelwert (n=5)!" has the words "mittelwert", "n", "5".
std::vector<std::string> plain_words(std::string_view text);

/// Returns the words of a text with + and - as parts of a word: "Lauf 1 X+" has the words "Lauf", "1", "X+".
std::vector<std::string> words_with_signs(std::string_view text);

// Functions that return the meaning of a word in a heading. The word of a heading is in small
// letters, in one of the languages that are usual in workshops.
bool says_target(const std::string& word);
bool says_measured(const std::string& word);
/// True for the position that the control shows: "Anzeige". Beside another measurement of the axis, this
/// position is the commanded one.
bool says_display(const std::string& word);
/// True for a statistic that a spreadsheet computes from its readings (a mean, a standard deviation or a
/// reversal error), for example "Mittelwert".
bool says_statistic(const std::string& word);
/// True for the French words of a standard deviation: "Écart-type".
bool says_standard_deviation(std::string_view text);
/// True for a heading with a word of a statistic, in one of its words: "Mittelwert hin [um]".
bool names_statistic(const sheet::Heading& heading);
/// True for a word of a run, in small letters: "lauf", "messreihe", "pass". A number follows it.
bool says_run(const std::string& word);
/// True for the number of a run, with one to three digits. More digits are a date or a number of a machine.
bool is_run_number(std::string_view word);
/// True for a direction of the survey and not of the axis: "hin", "rück", "forward".
bool says_way(const std::string& word);
bool says_deviation(const std::string& word);
/// True for a correction, the opposite of a deviation: "Korrektur", "Korrekturtabelle".
bool says_correction(const std::string& word);
/// True for a word of "after the correction" or "without compensation". A column with a heading of this kind
/// ("after the correction") does not contain a correction.
bool says_state_of_correction(const std::string& word);
/// True for a heading of values without a sign: "Betrag der Abweichung", "Absolute error", "|dX|".
bool says_magnitude(std::string_view heading);
/// True for a title with a word for a magnitude and a word for a deviation.
bool says_magnitude_of_deviation(std::string_view title);
/// An error perpendicular to the motion ("Geradheit") or a rotation during the motion ("Pitch"), if the
/// heading does not state its direction.
bool says_straightness(const std::string& word);
bool says_tilt(const std::string& word);
/// True for a column with a number or a name of each row: "Nr".
bool says_counting(const std::string& word);
/// True for a heading with such words alone: "lfd. Nr.".
bool heads_counting(const std::string& heading);

/// True for the text that a spreadsheet shows for a failed formula: "#BEZUG!", "#DIV/0!".
bool is_failed_formula(const std::string& cell);
/// True for a cell without a value: empty, a failed formula, "-", "n/a" …
bool is_missing(const std::string& cell);

/// True for the direction of an axis: "X+" is the direction + of the axis X.
bool is_axis_direction(std::string_view word);

/// Returns the approach direction that a word states: 1 for forward, +, hin …; -1 for back, -, zurück …; 0
/// for other words.
int sense_said(std::string_view word);
/// Returns the role that a word states: fit or check for "Anpassung", "Prüfung"; empty for another word.
std::string role_said(std::string_view word);

/// Returns the cells above the headings of a table.
std::vector<std::string> title_cells(const sheet::Sheet& sheet, const sheet::SheetTable& table);

/// True for a heading with a bar above a letter, the sign of a mean.
bool has_mean_bar(std::string_view heading);

/// Returns the only axis that the name of a sheet in a workbook states ("Y", "Y-Achse", "Laser Y"); empty if
/// the name states no axis or several axes. A, B and C alone are axes only beside the word "axis".
std::string axis_of_sheet_name(const sheet::Sheet& sheet);

/// Returns the only axis that the cells above the headings name; empty if they name no axis or several axes.
std::string axis_of_title_cells(const sheet::Sheet& sheet, const sheet::SheetTable& table);

/// Returns the only axis that the cells above the headings name ("Achse: X", "X-Achse", "Axis X"), or, if
/// they name no axis, that of the name of the sheet; empty if they name several axes.
std::string axis_of_titles(const sheet::Sheet& sheet, const sheet::SheetTable& table);

/// Returns the axis of the titles or of the name of the sheet for an example of an option, or X.
std::string axis_to_try(const sheet::Sheet& sheet, const sheet::SheetTable& table);

}  // namespace vernier::importer
