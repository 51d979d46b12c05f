// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/reading/unused_texts.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "tools/import/columns/column_guess.h"
#include "tools/import/words/doubtful_words.h"
#include "tools/import/words/sheet_words.h"
#include "tools/import/words/sign_words.h"
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
      return "may state that readings are not valid, and all of them are read: if so, delete their rows (or "
             "the column of their run) in the file, or write ungültig into a column Bemerkung of these rows";
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
    case Doubtful::kSentence:
    case Doubtful::kSign:
    case Doubtful::kIncrements:
    case Doubtful::kUnits:
      break;
  }
  return "";
}

/// True if a note quotes a text. That it is omitted, or read as a title, says nothing about its meaning.
bool is_used(const sheet::Sheet& sheet, const std::string& text) {
  return std::any_of(sheet.notes.begin(), sheet.notes.end(), [&](const std::string& note) {
    return note.find(text) != std::string::npos &&
           !note.ends_with("is a text below the table and is omitted") &&
           !note.ends_with("it is read as a title, and is no heading");
  });
}

/// True for a text with the word of an approach direction.
bool names_way(const std::string& text) {
  const std::vector<std::string> words = plain_words(text);
  return std::any_of(words.begin(), words.end(), [](const std::string& word) {
    return word.size() > 2 &&
           (sense_said(word) != 0 || word.starts_with("rückweg") || word.starts_with("hinweg"));
  });
}

std::string quoted_text(const TableText& text) {
  const std::string at = text.line > 0 ? fmt::format("line {}: ", text.line) : "";
  return fmt::format("{}the text \"{}\"", at, text.quoted());
}

}  // namespace

void note_unused_texts(sheet::Sheet& sheet, const sheet::SheetTable& table,
                       const std::vector<TableText>& texts, const std::vector<SheetColumn>& columns) {
  const bool directed = std::any_of(columns.begin(), columns.end(), [](const SheetColumn& one) {
    return one.use == SheetColumn::Use::kColumn && is_sense(one.name);
  });
  std::set<std::pair<std::size_t, Doubtful>> of_line;
  std::set<std::pair<std::string, Doubtful>> noted;
  std::vector<std::string> notes, sentences;
  for (const TableText& one : texts) {
    if (is_used(sheet, one.text)) continue;
    std::set<Doubtful> subjects = doubtful_in(one.text);
    // A cover sheet has many names; a remark in a row is about the row.
    const bool way = directed && names_way(one.text);  // the headings state the directions
    const bool sign = sign_said(one.text, SignPlace::kTitle) != SignSaid::kNothing;  // a rule reads it
    const bool other =
        !way && !sign &&
        (subjects.contains(Doubtful::kSentence) || (one.line > 0 && !is_of_a_protocol(one.text)));
    if (subjects.erase(Doubtful::kSentence);
        subjects.empty() && other && !one.in_row &&
        std::find(sentences.begin(), sentences.end(), quoted_text(one)) == sentences.end())
      sentences.push_back(quoted_text(one));
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
    if (unit.empty() || (one.line > 0 && !of_line.emplace(one.line, Doubtful::kUnits).second)) continue;
    notes.push_back(
        fmt::format("{} names the unit \"{}\", and no column is read with it: if the values of a column have "
                    "this unit, write "
                    "[{}] in place of the unit in its heading, or give --column \"NAME[{}]=HEADING\" "
                    "(deviations: --deviation)",
                    quoted_text(one), word, unit, unit));
  }
  constexpr std::size_t kShown = 5;  // sentences
  const std::size_t more = sentences.size() > kShown ? sentences.size() - kShown : 0;
  sentences.resize(sentences.size() - more);
  if (!sentences.empty())
    notes.push_back(
        fmt::format("{}{}: the import does not understand this and does not use it; if it changes values, "
                    "their sign (--sign), "
                    "positions or the way of a run, change the file accordingly",
                    text::joined(sentences, ", "), more > 0 ? fmt::format(" and {} more texts", more) : ""));
  sheet.notes.insert(sheet.notes.end(), notes.begin(), notes.end());
}

std::string advice_for_text(const std::string& text) {
  for (const Doubtful subject : doubtful_in(text))
    if (const std::string advice = advice_of(subject); !advice.empty())
      return fmt::format("the text {}", advice);
  return "";
}

}  // namespace vernier::importer
