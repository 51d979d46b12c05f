// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/reading/invalid_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tools/import/words/sheet_words.h"
#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

using WordSet = std::set<std::string, std::less<>>;

const WordSet kInvalidWords = {"ungültig",    "ungueltig", "ungültige",   "ungültiger", "ungültiges",
                               "invalid",     "verworfen", "discarded",   "void",       "rejected",
                               "fehlmessung", "discard",   "unbrauchbar", "unusable",   "reject"};

/// True for a remark that says that its row is no valid reading. A negation ("nicht ungültig") and a question
/// ("ungültig?") are no such remark.
bool says_invalid(const std::string& cell) {
  static const WordSet kValid = {"gültig", "gueltig", "valid"};
  static const WordSet kNot = {"nicht", "not", "kein", "keine", "keiner", "no", "never", "nie"};
  // No words of a tolerance ("n.i.O.", "not ok"): a reading out of tolerance is a valid reading.
  static const WordSet kWhole = {"non valable", "invalide", "do not use", "nicht verwenden"};
  if (cell.find('?') != std::string::npos) return false;
  if (kWhole.contains(text::in_small_letters(cell))) return true;
  bool invalid = false, valid = false, negated = false;
  for (const std::string& word : plain_words(cell)) {
    invalid |= kInvalidWords.contains(word);
    valid |= kValid.contains(word);
    negated |= kNot.contains(word);
  }
  return negated ? valid && !invalid : invalid;
}

/// True for a remark about another reading than that of its row: "Wiederholung, da erste ungültig war", but
/// not "ungültig, durch Wiederholung ersetzt".
bool is_about_another_reading(const std::string& cell) {
  static const WordSet kAgain = {"wiederholung", "wiederholt", "repeat",
                                 "repeated",     "repetition", "répétition"};
  static const WordSet kOther = {"erste", "ersten", "erster",   "vorige", "voriger", "vorherige", "previous",
                                 "first", "alte",   "original", "war",    "was",     "premier",   "première"};
  static const WordSet kInstead = {"ersetzt", "replaces", "statt", "instead", "remplace"};
  static const WordSet kPassive = {"durch", "by", "wird", "wurde", "par"};
  bool again = false, other = false, instead = false, passive = false;
  for (const std::string& word : plain_words(cell)) {
    again |= kAgain.contains(word);
    other |= kOther.contains(word);
    instead |= kInstead.contains(word);
    passive |= kPassive.contains(word);
  }
  return !passive && (instead || (again && other));
}

/// The columns of the run or the direction that a remark names beside the word for invalid ("Lauf 2
/// ungültig"); empty: the remark names none, or all columns.
std::vector<std::size_t> columns_named(const sheet::SheetTable& table, const std::string& cell) {
  std::vector<std::string> names;
  bool run = false, number = false, sense = false;
  for (const std::string& word : plain_words(cell)) {
    if (kInvalidWords.contains(word)) continue;
    const bool digits = word.find_first_not_of("0123456789") == std::string::npos;
    run |= says_run(word);
    number |= digits;
    sense |= !digits && sense_said(word) != 0;
    if (!says_run(word) && !digits && sense_said(word) == 0) return {};
    names.push_back(word);
  }
  if (!(run && number) && !sense) return {};
  std::vector<std::size_t> columns;
  std::size_t others = 0;
  for (std::size_t k = 0; k < table.headings.size(); ++k) {
    const std::vector<std::string> heading = plain_words(table.headings[k].name);
    const auto has = [&](const auto& name) {
      return std::find(heading.begin(), heading.end(), name) != heading.end();
    };
    const bool of_a_run = std::any_of(heading.begin(), heading.end(), [](const auto& word) {
      return says_run(word) || sense_said(word) != 0;
    });
    if (std::all_of(names.begin(), names.end(), has))
      columns.push_back(k);
    else
      others += of_a_run ? 1 : 0;
  }
  return others > 0 ? columns : std::vector<std::size_t>{};
}

/// What the cells of a column state by its heading: "Valid" with yes and no, "ungültig" with a mark.
enum class Flags { kNone, kOfValid, kOfInvalid, kOfState, kMarkOfValid };

Flags flags_of_heading(const sheet::Heading& heading) {
  static const WordSet kValid = {"valid",     "gültig", "gueltig",  "valide",    "verwenden",
                                 "verwendet", "use",    "used",     "auswerten", "berücksichtigen",
                                 "include",   "usable", "included", "brauchbar", "werten"};
  static const WordSet kInvalid = {"invalid", "ungültig", "ungueltig", "rejected",  "verworfen",
                                   "exclude", "excluded", "ignore",    "ignorieren"};
  static const WordSet kNot = {"nicht", "not"};
  static const WordSet kBeside = {"messung", "messwert",    "wert", "werte", "reading", "row",  "zeile",
                                  "punkt",   "measurement", "ist",  "is",    "point",   "value"};
  bool valid = false, invalid = false, negated = false;
  for (const std::string& word : plain_words(heading.text)) {
    valid |= kValid.contains(word);
    invalid |= kInvalid.contains(word);
    negated |= kNot.contains(word);
    if (!kValid.contains(word) && !kInvalid.contains(word) && !kNot.contains(word) && !kBeside.contains(word))
      return Flags::kNone;
  }
  if (valid == invalid) return Flags::kNone;
  return valid != negated ? Flags::kOfValid : Flags::kOfInvalid;
}

/// A column "gültig" with x in most rows, and nothing in the others.
bool has_marks_alone(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t column) {
  static const WordSet kMarks = {"x", "✓"};
  std::size_t marks = 0, empty = 0;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    if (sheet::is_blank(sheet.rows[row])) continue;
    const std::string cell = text::in_small_letters(sheet.rows[row][column]);
    if (!cell.empty() && !kMarks.contains(cell)) return false;
    ++(cell.empty() ? empty : marks);
  }
  return empty > 0 && marks > empty;
}

const WordSet kStatesOfFault = {"err", "error", "fehler", "fault", "störung", "invalid", "ungültig"};

/// A column "Status" with OK or a fault of the instrument in each row.
bool is_state_of_instrument(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t column) {
  static const WordSet kHeadings = {"status", "state", "zustand", "messstatus", "quality", "qualität"};
  static const WordSet kGood = {"ok", "okay", "valid", "gültig", "good", "gut"};
  const std::vector<std::string> heading = plain_words(table.headings[column].text);
  if (heading.size() != 1 || !kHeadings.contains(heading[0])) return false;
  bool good = false;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const std::string cell = text::in_small_letters(sheet.rows[row][column]);
    good |= kGood.contains(cell);
    if (!cell.empty() && !kGood.contains(cell) && !kStatesOfFault.contains(cell)) return false;
  }
  return good;
}

Flags flags_of(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t column) {
  static const WordSet kAnswers = {"",  "yes",  "no", "ja", "nein",  "oui", "non", "y", "n",
                                   "j", "true", "0",  "1",  "false", "x",   "✓",   "-"};
  Flags flags = flags_of_heading(table.headings[column]);
  if (flags == Flags::kNone && is_state_of_instrument(sheet, table, column)) return Flags::kOfState;
  for (std::size_t row = table.first_data; flags != Flags::kNone && row < sheet.rows.size(); ++row)
    if (!kAnswers.contains(text::in_small_letters(sheet.rows[row][column]))) return Flags::kNone;
  if (flags == Flags::kOfValid && has_marks_alone(sheet, table, column)) return Flags::kMarkOfValid;
  return flags;
}

bool flag_says_invalid(Flags flags, const std::string& cell) {
  static const WordSet kNo = {"no", "nein", "non", "n", "false", "0"};
  static const WordSet kNoMark = {"", "-"};
  const std::string small = text::in_small_letters(cell);
  if (flags == Flags::kOfState) return kStatesOfFault.contains(small);
  if (flags == Flags::kMarkOfValid) return cell.empty();
  if (flags == Flags::kOfValid) return kNo.contains(small);
  return flags == Flags::kOfInvalid && !kNo.contains(small) && !kNoMark.contains(small);
}

/// The word for invalid in a remark.
std::string invalid_word(const std::string& cell) {
  for (const std::string& word : plain_words(cell))
    if (kInvalidWords.contains(word)) return word;
  return "invalid";
}

/// Removes the readings of one run from a row.
void empty_cells(sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t row, std::size_t remark,
                 const std::vector<std::size_t>& columns) {
  std::vector<std::string> headings;
  for (const std::size_t k : columns) {
    if (k >= sheet.rows[row].size()) continue;
    sheet.rows[row][k].clear();
    headings.push_back(fmt::format("\"{}\"", table.headings[k].text));
  }
  sheet.notes.push_back(fmt::format(
      "line {}: this row says \"{}\", and its cell of {} is omitted; the other cells of the row are read",
      sheet.line[row], sheet.rows[row][remark], text::joined(headings, ", ")));
}

}  // namespace

void leave_invalid_rows(sheet::Sheet& sheet, const sheet::SheetTable& table) {
  std::vector<std::pair<std::size_t, std::string>> invalid;
  std::vector<Flags> flags;
  for (std::size_t k = 0; table.has_headings && k < table.headings.size(); ++k)
    flags.push_back(flags_of(sheet, table, k));
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const std::vector<std::string>& cells = sheet.rows[row];
    for (std::size_t k = 0; k < cells.size() && !sheet::is_blank(cells); ++k) {
      const bool flagged = k < flags.size() && flag_says_invalid(flags[k], cells[k]);
      if (!flagged && !says_invalid(cells[k])) continue;
      if (!flagged && is_about_another_reading(cells[k])) {
        sheet.notes.push_back(fmt::format(
            "line {}: the remark \"{}\" is about another reading, and this row is read; if its own "
            "reading is invalid, write \"{}\" alone",
            sheet.line[row], cells[k], invalid_word(cells[k])));
        break;
      }
      if (const auto columns = flagged ? std::vector<std::size_t>() : columns_named(table, cells[k]);
          !columns.empty()) {
        empty_cells(sheet, table, row, k, columns);
        break;
      }
      invalid.emplace_back(
          row,
          flagged ? table.headings[k].name + ": " + (cells[k].empty() ? "no mark" : cells[k]) : cells[k]);
      break;
    }
  }
  if (invalid.empty()) return;
  std::size_t rows = 0;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
    rows += sheet::is_blank(sheet.rows[row]) ? 0 : 1;
  if (invalid.size() >= rows)
    throw text::InputError(
        {sheet.file, sheet.line[invalid.front().first]}, invalid.front().second,
        "each row of the table says that it is invalid: measure again, or delete this column in the file");
  for (const auto& [row, word] : invalid)
    sheet.notes.push_back(
        fmt::format("line {}: this row says \"{}\" and is omitted; if its reading is valid, delete these "
                    "words in the file",
                    sheet.line[row], word));
  for (auto one = invalid.rbegin(); one != invalid.rend(); ++one) sheet::remove_row(sheet, one->first);
}

}  // namespace vernier::importer
