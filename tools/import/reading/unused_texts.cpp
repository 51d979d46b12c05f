// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/reading/unused_texts.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "tools/import/columns/column_guess.h"
#include "tools/import/words/doubtful_words.h"
#include "tools/import/words/sheet_words.h"
#include "tools/import/words/sign_words.h"
#include "tools/import/words/unread_words.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

/// What a text may state, and what to do.
const char* advice_of(Doubtful subject) {
  switch (subject) {
    case Doubtful::kFactor:
      return "may state a factor of the values, and the values are read as they are written: if they are not "
             "the quantity of the heading itself, divide (or multiply) them by the factor in the file, and "
             "delete this text";
    case Doubtful::kAddition:
      return "may state that a number was added to the values or taken from them, and the values are read as "
             "they are written: if so, subtract (or add) the number in the file, and delete this text";
    case Doubtful::kInvalid:
      return "may state that readings are not valid, and none are left out because of it: if so, delete "
             "their rows (or the column of their run) in the file, or write ungültig into a column Bemerkung "
             "of these rows";
    case Doubtful::kZero:
      return "may state another zero point, and positions and values are read as they are written: if the "
             "positions are not those of the machine, add the distance of the two zero points to them in the "
             "file (another axis that stands still: --set \"Y[mm]=150\"); if the instrument was set to zero "
             "again between two rows, subtract the step from the values behind it";
    case Doubtful::kBackOrder:
      return "may state the order of the readings, and each is read at the position of its row: if the "
             "readings of the way back are in the order of their measurement, reverse the order of the "
             "values "
             "of this column in the file";
    case Doubtful::kDirections:
      return "may state approach directions, and none are read from it: add a column Richtung with vor or "
             "zurück in each row (if each run has a column: write + or - behind the number of the run in its "
             "heading)";
    case Doubtful::kCodes:
      return "may state the meaning of a code, and it is not used: write + and - (+ is the direction of "
             "increasing positions) into the column of the directions";
    case Doubtful::kSign:
    case Doubtful::kIncrements:
    case Doubtful::kUnits:
      break;
  }
  return "";
}

constexpr std::string_view kBelow = "is a text below the table and is omitted";
constexpr std::string_view kTitle = "it is read as a title, and is no heading";

/// True if a note quotes a text. That it is omitted, or read as a title, says nothing about its meaning.
bool is_used(const sheet::Sheet& sheet, const std::string& text) {
  return std::any_of(sheet.notes.begin(), sheet.notes.end(), [&](const std::string& note) {
    return note.find(text) != std::string::npos && !note.ends_with(kBelow) && !note.ends_with(kTitle);
  });
}

std::string quoted_text(const TableText& text) {
  const std::string at = text.line > 0 ? fmt::format("line {}: ", text.line) : "";
  return fmt::format("{}the text \"{}\"", at, text.quoted());
}

/// True if a note quotes a cell of this line.
bool is_partly_used(const sheet::Sheet& sheet, const std::vector<TableText>& texts, const TableText& line) {
  return std::any_of(texts.begin(), texts.end(), [&](const TableText& cell) {
    return cell.line == line.line && line.text.find(cell.text) != std::string::npos &&
           is_used(sheet, cell.text);
  });
}

/// True for a short text of a cover sheet with a word that names a fact about the measurement ("Maschine",
/// "Datum der Messung"), or with a number ("Portal 4", "XL-80").
bool is_label_of_cover(const std::string& text) {
  static const std::set<std::string> kLabels = {
      "maschine",   "machine",      "datum",         "date",      "prüfer",  "operator",   "kunde",
      "customer",   "seriennummer", "serial",        "auftrag",   "order",   "firma",      "company",
      "temperatur", "temperature",  "achse",         "axis",      "laser",   "gerät",      "device",
      "instrument", "messgerät",    "bediener",      "ort",       "place",   "halle",      "protokoll",
      "report",     "deckblatt",    "messprotokoll", "steuerung", "control", "hersteller", "manufacturer",
      "typ",        "type",         "nummer",        "number",    "projekt", "project",    "abteilung",
      "messung",    "measurement",  "standort",      "location",  "name",    "luftdruck",  "luftfeuchte"};
  constexpr std::size_t kSentence = 3;  // words
  const std::vector<std::string> words = plain_words(text);
  if (words.size() >= kSentence) return false;
  return std::any_of(words.begin(), words.end(), [](const std::string& word) {
    return kLabels.contains(word) || word.find_first_of("0123456789") != std::string::npos;
  });
}

/// One note with all texts that no other note quotes: no list of words is complete.
void note_other_texts(sheet::Sheet& sheet, const sheet::SheetTable& table,
                      const std::vector<TableText>& texts, const std::vector<SheetColumn>& columns) {
  constexpr std::size_t kShown = 12;  // texts; a protocol has about ten lines
  std::vector<TableText> all = texts;
  if (sheet.workbook && is_telling_name(sheet.sheet) && !is_used(sheet, sheet.sheet))
    all.push_back({0, "name of the sheet: " + sheet.sheet});
  std::vector<const TableText*> left;
  for (const TableText& one : all) {
    // A line is also one text for each of its cells: the line is quoted, or the cells that no note quotes.
    bool again = std::any_of(left.begin(), left.end(),
                             [&](const TableText* other) { return other->quoted() == one.quoted(); });
    for (const TableText& other : all) {
      if (other.line == 0 || other.line != one.line || other.text == one.text) continue;
      again |= one.text.find(other.text) != std::string::npos && is_used(sheet, other.text);
      again |= other.text.find(one.text) != std::string::npos && !is_partly_used(sheet, all, other);
    }
    // The labels of a cover sheet ("Maschine"), and an upper line of headings, are no sentences.
    const bool label = one.line == 0 && is_label_of_cover(one.text);
    const bool heading = table.upper_row && one.line == sheet.line[*table.upper_row];
    const bool refused = std::any_of(columns.begin(), columns.end(), [&](const SheetColumn& column) {
      return column.sign_text == one.text || column.sign_text == one.quoted();
    });
    if (!one.in_row && !label && !heading && !refused && !again && !is_used(sheet, one.text))
      left.push_back(&one);
  }
  std::erase_if(sheet.notes, [&](const std::string& note) {
    return note.ends_with(kBelow) && std::any_of(texts.begin(), texts.end(), [&](const TableText& one) {
             return note.find("\"" + one.text + "\"") != std::string::npos;
           });
  });  // another note quotes them
  if (left.empty()) return;
  std::stable_sort(left.begin(), left.end(),
                   [](const TableText* a, const TableText* b) { return a->line < b->line; });
  // A sentence that changes numbers has more words than a line of a protocol.
  std::vector<const TableText*> shown = left;
  std::stable_sort(shown.begin(), shown.end(), [](const TableText* a, const TableText* b) {
    return plain_words(a->text).size() > plain_words(b->text).size();
  });
  shown.resize(std::min(kShown, shown.size()));
  std::string list;
  for (const TableText* one : left) {
    if (std::find(shown.begin(), shown.end(), one) == shown.end()) continue;
    list += list.empty() ? "" : ", ";
    list += one->line > 0 ? fmt::format("line {} \"{}\"", one->line, text::trimmed(one->text))
                          : fmt::format("\"{}\"", one->quoted());
  }
  if (left.size() > shown.size()) list += fmt::format(" and {} shorter texts", left.size() - shown.size());
  sheet.notes.push_back(
      fmt::format("beside the table: {}. Does one of these texts change values, their sign (--sign) or unit, "
                  "positions, or the order or way of a run? Then change the file accordingly",
                  list));
}

}  // namespace

void note_unused_texts(sheet::Sheet& sheet, const sheet::SheetTable& table,
                       const std::vector<TableText>& texts, const std::vector<SheetColumn>& columns) {
  const bool directed = std::any_of(columns.begin(), columns.end(), [](const SheetColumn& one) {
    return one.use == SheetColumn::Use::kColumn && is_sense(one.name);
  });
  std::set<std::pair<std::size_t, Doubtful>> of_line;
  std::set<std::pair<std::string, Doubtful>> noted;
  std::vector<std::string> notes;
  for (const TableText& one : texts) {
    if (is_used(sheet, one.text)) continue;
    const std::set<Doubtful> subjects = doubtful_in(one.text);
    for (const Doubtful subject : subjects) {
      const std::string advice = advice_of(subject);
      if (advice.empty() || (subject == Doubtful::kDirections && directed) ||
          (subject == Doubtful::kCodes && !directed) ||
          (subject == Doubtful::kAddition && subjects.contains(Doubtful::kSign)) ||  // a correction
          (one.line > 0 && !of_line.emplace(one.line, subject).second) ||
          !noted.emplace(one.text, subject).second)
        continue;
      notes.push_back(fmt::format("{} {}", quoted_text(one), advice));
    }
    const auto [word, unit] =
        one.in_row ? std::pair<std::string, std::string>() : unit_against_headings(one.text, table);
    const bool is_read = std::any_of(columns.begin(), columns.end(), [&, symbol = unit](const auto& column) {
      return column.use != SheetColumn::Use::kLeft && column.unit == symbol;
    });  // the unit of a title
    if (unit.empty() || is_read || (one.line > 0 && !of_line.emplace(one.line, Doubtful::kUnits).second))
      continue;
    notes.push_back(
        fmt::format("{} names the unit \"{}\", and no column is read with it: if the values of a column have "
                    "this unit, write "
                    "[{}] in place of the unit in its heading (to a heading without a unit: --column "
                    "\"NAME[{}]=HEADING\", for deviations --deviation)",
                    quoted_text(one), word, unit, unit));
  }
  sheet.notes.insert(sheet.notes.end(), notes.begin(), notes.end());
  note_other_texts(sheet, table, texts, columns);
}

std::string advice_for_text(const std::string& text) {
  for (const Doubtful subject : doubtful_in(text))
    if (const std::string advice = advice_of(subject); !advice.empty())
      return fmt::format("the text {}", advice);
  if (may_state(text, Doubtful::kSign) || sign_said(text, SignPlace::kTitle) != SignSaid::kNothing)
    return "the text may state another sign of the deviations: if it is about the rows below it, reverse "
           "their "
           "values in the file before you delete the text; if it is about all rows, give --sign "
           "nominal-actual "
           "or --sign actual-nominal";
  return "";
}

}  // namespace vernier::importer
