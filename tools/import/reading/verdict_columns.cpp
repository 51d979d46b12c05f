// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/reading/verdict_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>

#include "tools/import/words/sheet_words.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

using WordSet = std::set<std::string, std::less<>>;

/// The words of a heading or a cell with one blank between them: "i.O.", "I. O." and "i O" are "i o".
std::string plain_words_of(const std::string& text) { return text::joined(plain_words(text), " "); }

enum class Verdict { kNoVerdict, kByItsCells, kVerdict };

Verdict verdict_in(const sheet::Heading& heading) {
  static const WordSet kVerdicts = {"ok",
                                    "okay",
                                    "o k",
                                    "ok nok",
                                    "ok nio",
                                    "ok n ok",
                                    "nok",
                                    "n ok",
                                    "not ok",
                                    "nicht ok",
                                    "ok nicht ok",
                                    "io",
                                    "i o",
                                    "nio",
                                    "n i o",
                                    "io nio",
                                    "i o n i o",
                                    "in ordnung",
                                    "nicht in ordnung",
                                    "pass fail",
                                    "passed",
                                    "failed",
                                    "fail",
                                    "passed failed",
                                    "go nogo",
                                    "go no go",
                                    "gut schlecht",
                                    "good bad",
                                    "bewertung",
                                    "beurteilung",
                                    "urteil",
                                    "verdict",
                                    "assessment",
                                    "evaluation",
                                    "judgement",
                                    "judgment",
                                    "in toleranz",
                                    "in tol",
                                    "in tolerance",
                                    "within tolerance",
                                    "toleranz ok",
                                    "tol ok",
                                    "tolerance ok",
                                    "prüfurteil",
                                    "conforme",
                                    "conformité",
                                    "valid",
                                    "gültig",
                                    "gueltig",
                                    "invalid",
                                    "ungültig",
                                    "ungueltig"};
  static const WordSet kByCells = {"ergebnis", "prüfergebnis", "result", "status", "pass",    "test",
                                   "toleranz", "tolerance",    "befund", "check",  "prüfung", "résultat"};
  if (!heading.unit.empty()) return Verdict::kNoVerdict;
  const std::string words = plain_words_of(heading.name);
  return kVerdicts.contains(words)  ? Verdict::kVerdict
         : kByCells.contains(words) ? Verdict::kByItsCells
                                    : Verdict::kNoVerdict;
}

bool is_verdict(const std::string& cell) {
  static const WordSet kWords = {"ok",
                                 "okay",
                                 "o k",
                                 "nok",
                                 "n ok",
                                 "not ok",
                                 "nicht ok",
                                 "io",
                                 "i o",
                                 "nio",
                                 "n i o",
                                 "pass",
                                 "fail",
                                 "passed",
                                 "failed",
                                 "gut",
                                 "schlecht",
                                 "good",
                                 "bad",
                                 "in ordnung",
                                 "nicht in ordnung",
                                 "✓",
                                 "✗",
                                 "bestanden",
                                 "nicht bestanden"};
  return kWords.contains(plain_words_of(cell));
}

bool has_decimals(const sheet::Sheet& sheet, const std::string& cell) {
  return sheet::plain_number(cell, sheet.decimal_comma) && sheet::decimals_of(cell, sheet.decimal_comma) > 0;
}

template <typename Test>
bool all_filled(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t k, const Test& test) {
  bool any = false;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    if (is_missing(sheet.rows[row][k])) continue;
    if (!test(sheet.rows[row][k])) return false;
    any = true;
  }
  return any;
}

/// Why a column is no measurement; empty: it may be one.
std::string why_left(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t k) {
  const auto number = [&](const std::string& cell) {
    return sheet::plain_number(cell, sheet.decimal_comma).has_value();
  };
  if (names_remark(table.headings[k]) && all_filled(sheet, table, k, number))
    return "has remarks and no measurement";
  const Verdict names = verdict_in(table.headings[k]);
  bool decimals = false;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
    decimals |= has_decimals(sheet, sheet.rows[row][k]);
  const bool verdict = (names == Verdict::kVerdict && !decimals) ||
                       (names == Verdict::kByItsCells && all_filled(sheet, table, k, is_verdict));
  return verdict ? "has a verdict about the readings and no measurement (readings out of tolerance are read)"
                 : "";
}

/// The rows whose verdict is not that of most rows: "; line 19: \"NIO\"". Empty: too many, or none.
std::string rows_of_other_verdicts(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t k) {
  constexpr std::size_t kShown = 5;  // rows
  std::map<std::string, std::size_t> count;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) ++count[sheet.rows[row][k]];
  if (count.size() < 2) return "";
  const auto most = std::max_element(count.begin(), count.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  const std::size_t others = sheet.rows.size() - table.first_data - most->second;
  if (most->second <= others) return "";
  std::string list;
  std::size_t shown = 0;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const std::string& cell = sheet.rows[row][k];
    if (cell == most->first || sheet::is_blank(sheet.rows[row]) || ++shown > kShown) continue;
    list += fmt::format("{}line {} {}", list.empty() ? "" : ", ", sheet.line[row],
                        cell.empty() ? "is empty there" : "has \"" + cell + "\"");
  }
  if (list.empty()) return "";
  return fmt::format("; {}{}: if a row there does not count, delete it in the file", list,
                     shown > kShown ? fmt::format(" and {} more", shown - kShown) : "");
}

}  // namespace

bool names_remark(const sheet::Heading& heading) {
  static const WordSet kWords = {"bemerkung",   "bemerkungen", "bem",     "kommentar", "kommentare",
                                 "comment",     "comments",    "remark",  "remarks",   "anmerkung",
                                 "anmerkungen", "notiz",       "notizen", "note",      "notes",
                                 "hinweis",     "hinweise",    "remarque"};
  return heading.unit.empty() && kWords.contains(plain_words_of(heading.name));
}

void leave_verdicts(sheet::Sheet& sheet, sheet::SheetTable& table, const std::vector<std::string>& named) {
  if (!table.has_headings) return;
  for (std::size_t k = 0; k < table.headings.size(); ++k) {
    sheet::Heading& heading = table.headings[k];
    const bool by_option = std::any_of(named.begin(), named.end(), [&](const std::string& option) {
      return option.find(heading.name) != std::string::npos;
    });
    const std::string why = by_option ? "" : why_left(sheet, table, k);
    if (why.empty()) continue;
    sheet.notes.push_back(
        fmt::format("the column \"{}\" {}: it is omitted; to keep it as a label of its rows, "
                    "give --column \"NAME={}\"{}",
                    heading.text, why, heading.text, rows_of_other_verdicts(sheet, table, k)));
    // An empty column keeps the numbers of the columns behind it, by which an option may name them.
    for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) sheet.rows[row][k].clear();
    heading.name = "verdict";
  }
}

}  // namespace vernier::importer
