// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/columns/column_signs.h"

#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "tools/import/columns/column_guess.h"
#include "tools/import/words/doubtful_words.h"
#include "tools/import/words/sign_words.h"
#include "tools/import/words/table_texts.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/numbers.h"

namespace vernier::importer {
namespace {

/// A text about the sign of deviations, and what it states.
struct SignText {
  SignSaid said = SignSaid::kNothing;
  std::size_t line = 0;
  std::string text;
  bool in_row = false;

  void add(SignSaid sign, std::size_t at, const std::string& words, bool of_row = false) {
    const SignSaid both = both_signs(said, sign);
    if (both != said) *this = {both, at, words, of_row};
  }
};

/// The sign that the file states outside the headings: in titles, remarks, and cells of words in the rows.
SignText sign_of_texts(const sheet::Sheet& sheet, const sheet::SheetTable& table, Travel travel) {
  SignText found;
  for (const TableText& one : texts_about(sheet, table)) {
    SignSaid said = sign_said(one.text, SignPlace::kTitle, travel);
    if (said == SignSaid::kUnclear && says_sign_is_usual(one.text)) continue;
    // No rule reads the text, and its words may be about the sign. A remark of one row is about this row.
    if (said == SignSaid::kNothing && !one.in_row && may_state(one.text, Doubtful::kSign) &&
        !says_sign_is_usual(one.text))
      said = SignSaid::kUnclear;
    found.add(said, one.line, one.quoted(), one.in_row);
  }
  return found;
}

/// The side of zero of the positions of the axis of a deviation: of its targets, or else of its readings.
Travel travel_of(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                 const std::vector<SheetColumn>& columns, const SheetColumn& deviation,
                 const std::vector<MappedColumn>& constants) {
  bool above = false, below = false;
  const auto count = [&](std::optional<double> value) {
    above |= value && *value > 0;
    below |= value && *value < 0;
  };
  const std::string positions = deviation.to_target ? *reading_of(deviation.name) : deviation.name;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k].use != SheetColumn::Use::kColumn || columns[k].name != positions) continue;
    for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
      if (const auto number = sheet::plain_number(sheet.rows[row][k], sheet.decimal_comma))
        count(text::parse_number(*number));
  }
  for (const MappedColumn& constant : constants)
    if (constant.name == positions) count(text::parse_number(constant.constant));
  if (above && below) return Travel::kBothSides;
  return below ? Travel::kNegative : Travel::kPositive;
}

/// The sign of one column of deviations: by its heading, or by the texts.
void settle_sign(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t k,
                 SheetColumn& column, const SignText& texts, Travel travel) {
  const sheet::Heading& heading = table.headings[k];
  SignText sign;
  sign.add(sign_said(heading.text, SignPlace::kHeading, travel), sheet.line[table.heading_row], heading.text);
  if (sign.said == SignSaid::kNothing && names_correction(heading))
    sign.said = SignSaid::kNominalLessActual;  // the titles are about deviations
  else if (sign.said == SignSaid::kNothing || sign.said == SignSaid::kUnclear ||
           texts.said != SignSaid::kUnclear)  // a clear heading outranks a doubtful text, which is quoted
    sign.add(texts.said, texts.line, texts.text, texts.in_row);
  if (sign.said != SignSaid::kNothing && sign.text == texts.text) column.sign_from = texts.text;
  column.turned = sign.said == SignSaid::kNominalLessActual;
  if (sign.said != SignSaid::kUnclear) return;
  column.sign_place = {sheet.file, sign.line};
  column.sign_text = sign.text;
  column.sign_of_row = sign.in_row;
}

}  // namespace

void settle_signs(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                  std::vector<SheetColumn>& columns, const SheetWishes& wishes) {
  std::map<Travel, SignText> of_travel;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    SheetColumn& column = columns[k];
    if (column.use != SheetColumn::Use::kDeviation) continue;
    if (wishes.turned) {
      column.turned = *wishes.turned;
      continue;
    }
    const Travel travel = travel_of(sheet, table, columns, column, wishes.constants);
    if (!of_travel.contains(travel)) of_travel[travel] = sign_of_texts(sheet, table, travel);
    const SignText& texts = of_travel[travel];
    settle_sign(sheet, table, k, column, texts, travel);
  }
}

void settle_sign_of_lengths(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t k,
                            SheetColumn& column) {
  settle_sign(sheet, table, k, column, sign_of_texts(sheet, table, Travel::kPositive), Travel::kPositive);
}

}  // namespace vernier::importer
