// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/tables/run_signs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/import/columns/column_guess.h"
#include "tools/import/words/sheet_words.h"
#include "tools/maths/median.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

bool has_negative(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t k) {
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
    if (const auto value = sheet::number_at(sheet, row, k); value && *value < 0) return true;
  return false;
}

/// True if the sizes of both runs agree in the rows in which `run` is negative, and the other one is not.
bool lost_its_signs(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t run,
                    std::size_t other) {
  constexpr std::size_t kFewest = 3;  // fewer rows agree by chance
  constexpr double kShare = 0.2;      // of the size: the scatter of runs is below a fifth of it
  std::vector<double> sizes, apart;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto a = sheet::number_at(sheet, row, run), b = sheet::number_at(sheet, row, other);
    if (!a || !b || *a >= 0) continue;
    sizes.push_back(-*a);
    apart.push_back(std::abs(*b + *a));
  }
  return sizes.size() >= kFewest && maths::median(apart) < kShare * maths::median(sizes);
}

enum class Sign { kNone, kPlus, kMinus };

using WordSet = std::set<std::string, std::less<>>;

/// The sign in a cell; kNone for another text.
Sign sign_in(const std::string& cell) {
  static const WordSet kPlus = {"+", "plus", "pos", "positiv", "positive"};
  static const WordSet kMinus = {"-", "\u2212", "\u2013", "minus", "neg", "negativ", "negative"};
  const std::string small = text::in_small_letters(cell);
  return kPlus.contains(small) ? Sign::kPlus : kMinus.contains(small) ? Sign::kMinus : Sign::kNone;
}

/// The sign that words about a size state for positions above zero: "zu weit", "too short", "over".
Sign size_in(const std::string& cell) {
  static const WordSet kMore = {"zu groß", "zu gross", "zu lang",   "zu weit",   "too large",
                                "too big", "too long", "too far",   "over",      "overshoot",
                                "larger",  "größer",   "trop long", "trop loin", "trop grand"};
  static const WordSet kLess = {"zu klein",   "zu kurz", "too small", "too short",  "under",
                                "undershoot", "smaller", "kleiner",   "trop court", "trop petit"};
  const std::string words = text::joined(plain_words(cell), " ");
  return kMore.contains(words) ? Sign::kPlus : kLess.contains(words) ? Sign::kMinus : Sign::kNone;
}

bool names_sign(const sheet::Heading& heading) {
  static const WordSet kWords = {"vz", "vorz", "vorzeichen", "sign", "+/-", "\u00b1"};
  std::string small = text::in_small_letters(heading.text);
  while (small.ends_with('.')) small.pop_back();
  return kWords.contains(small);
}

/// True for a heading that may be about the sign of a deviation: of a remark, or with no word for a
/// direction.
bool may_name_sign(const sheet::Heading& heading) {
  static const WordSet kWords = {"lage", "bemerkung", "bemerkungen", "hinweis",   "remark", "remarks",
                                 "note", "comment",   "kommentar",   "anmerkung", "wo",     "art"};
  const std::vector<std::string> words = plain_words(heading.text);
  return names_sign(heading) || (words.size() == 1 && kWords.contains(words[0]));
}

bool is_column_of_deviations(const sheet::Heading& heading) {
  const std::vector<std::string> words = plain_words(heading.name);
  return std::any_of(words.begin(), words.end(), says_deviation);
}

/// The column of the magnitudes that a column of signs belongs to: the one at its right if the heading names
/// a sign, the only column of deviations, or the one beside it.
std::optional<std::size_t> magnitudes_beside(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                             std::size_t k) {
  const auto numbers = [&](std::size_t at) {
    for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
      if (sheet::number_at(sheet, row, at)) return true;
    return false;
  };
  if (names_sign(table.headings[k]) && k + 1 < table.headings.size() && numbers(k + 1)) return k + 1;
  std::vector<std::size_t> deviations;
  for (std::size_t at = 0; at < table.headings.size(); ++at)
    if (at != k && is_column_of_deviations(table.headings[at]) && numbers(at)) deviations.push_back(at);
  if (deviations.size() == 1) return deviations.front();
  for (const std::size_t at : deviations)
    if (at + 1 == k) return at;
  return std::nullopt;
}

/// True if a position of the table is below zero: "zu kurz" is there a deviation above zero.
bool has_negative_position(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t numbers) {
  for (std::size_t k = 0; k < table.headings.size(); ++k) {
    if (k != numbers && !is_column_of_deviations(table.headings[k]) && !table.headings[k].unit.empty() &&
        has_negative(sheet, table, k))
      return true;
  }
  return false;
}

/// The words of a column of signs.
struct SignCells {
  std::size_t signs = 0, sizes = 0, others = 0, empty = 0;
};

SignCells sign_cells_of(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t k,
                        std::size_t numbers) {
  SignCells cells;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const std::string& cell = sheet.rows[row][k];
    const auto value = sheet::number_at(sheet, row, numbers);
    if (!value || *value == 0) continue;
    ++(cell.empty()                   ? cells.empty
       : sign_in(cell) != Sign::kNone ? cells.signs
       : size_in(cell) != Sign::kNone ? cells.sizes
                                      : cells.others);
  }
  return cells;
}

void apply(sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t signs, std::size_t numbers) {
  const std::string &heading = table.headings[signs].text, &of = table.headings[numbers].text;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    std::string& cell = sheet.rows[row][numbers];
    const auto value = sheet::number_at(sheet, row, numbers);
    if (!value) continue;
    const Sign stated = sign_in(sheet.rows[row][signs]);
    const Sign sign = stated == Sign::kNone ? size_in(sheet.rows[row][signs]) : stated;
    if (*value < 0 || (sign == Sign::kNone && *value != 0))
      throw text::InputError(
          {sheet.file, sheet.line[row]}, *value < 0 ? cell : sheet.rows[row][signs],
          fmt::format(
              "\"{}\" has the signs of \"{}\", but {}: write the signs into \"{}\", and leave the column of "
              "the signs out (--leave \"{}\")",
              heading, of, *value < 0 ? "this value has a sign of its own" : "this row has no sign", of,
              heading));
    if (sign == Sign::kMinus && *value != 0)
      cell.insert(cell.starts_with('+') ? cell.erase(0, 1).begin() : cell.begin(), '-');
    if (names_sign(table.headings[signs])) sheet.rows[row][signs].clear();
  }
}

/// Refuses words about a size if "zu kurz" is above zero for some positions.
void refuse_both_sides(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t signs,
                       std::size_t numbers) {
  if (!has_negative_position(sheet, table, numbers)) return;
  throw text::InputError(
      {sheet.file, sheet.line[table.first_data]}, sheet.rows[table.first_data][signs],
      fmt::format("\"{0}\" has the signs of \"{1}\" in words about a size, and the table has positions below "
                  "zero, where the sign of these words is not clear: write the signs (actual - nominal) into "
                  "\"{1}\", and leave the column of the words out (--leave \"{0}\")",
                  table.headings[signs].text, table.headings[numbers].text));
}

/// Refuses a column of signs whose words are not known.
[[noreturn]] void refuse_unread_signs(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                      std::size_t signs, std::size_t numbers) {
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const std::string& cell = sheet.rows[row][signs];
    if (cell.empty() || sign_in(cell) != Sign::kNone || size_in(cell) != Sign::kNone) continue;
    throw text::InputError(
        {sheet.file, sheet.line[row]}, cell,
        fmt::format(
            "\"{0}\" states the signs of \"{1}\", and this word is no known sign: write + or - (actual "
            "- nominal); if the column is no sign, give --leave \"{0}\"",
            table.headings[signs].text, table.headings[numbers].text));
  }
  throw text::InputError({sheet.file, sheet.line[table.first_data]}, "", "a column of signs has no word");
}

/// Reads two columns of magnitudes whose headings state their signs ("zu kurz [um]", "zu lang [um]") as one
/// column of deviations, with a note.
void join_magnitudes(sheet::Sheet& sheet, sheet::SheetTable& table, std::size_t more, std::size_t less) {
  const std::string heading = table.headings[more].text, other = table.headings[less].text;
  refuse_both_sides(sheet, table, more, more);
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto above = sheet::number_at(sheet, row, more), below = sheet::number_at(sheet, row, less);
    if ((above && *above < 0) || (below && *below < 0) || (above && below && *above != 0 && *below != 0))
      throw text::InputError(
          {sheet.file, sheet.line[row]}, sheet.rows[row][less],
          fmt::format(
              "\"{}\" and \"{}\" state a size in one of two directions, but this row has two sizes or "
              "a negative one: write one column of deviations (actual - nominal)",
              heading, other));
    if (below && (!above || *above == 0))
      sheet.rows[row][more] = (*below > 0 ? "-" : "") + sheet.rows[row][less];
    sheet.rows[row][less].clear();
  }
  table.headings[more].name = "Abweichung";
  table.headings[less].name = "signs";
  sheet.notes.push_back(
      fmt::format("\"{}\" and \"{}\" are read as one column of deviations, positive for \"{}\"", heading,
                  other, heading));
}

void join_two_magnitudes(sheet::Sheet& sheet, sheet::SheetTable& table) {
  std::optional<std::size_t> more, less;
  for (std::size_t k = 0; k < table.headings.size(); ++k) {
    const Sign sign = size_in(table.headings[k].name);
    if (is_column_of_deviations(table.headings[k])) return;
    if (sign == Sign::kPlus) more = k;
    if (sign == Sign::kMinus) less = k;
  }
  if (more && less && table.headings[*more].unit == table.headings[*less].unit && column_of_positions(table))
    join_magnitudes(sheet, table, *more, *less);
}

}  // namespace

void note_unsigned_runs(sheet::Sheet& sheet, const sheet::SheetTable& table,
                        const std::vector<std::size_t>& runs) {
  for (const std::size_t other : runs) {
    if (has_negative(sheet, table, other)) continue;
    const auto run = std::find_if(runs.begin(), runs.end(), [&](std::size_t one) {
      return one != other && lost_its_signs(sheet, table, one, other);
    });
    if (run == runs.end()) continue;
    sheet.notes.push_back(
        fmt::format("\"{0}\" has no negative value, and its values have the sizes of the negative values of "
                    "\"{1}\": are the "
                    "minus signs lost? The values are read; if they are wrong, correct the column in the "
                    "file, or delete it",
                    table.headings[other].text, table.headings[*run].text));
  }
}

void apply_sign_column(sheet::Sheet& sheet, sheet::SheetTable& table, const std::vector<std::string>& named) {
  if (!table.has_headings) return;
  const auto by_option = [&](std::size_t k) {
    return std::any_of(named.begin(), named.end(), [&](const std::string& option) {
      return option.find(table.headings[k].text) != std::string::npos;
    });
  };
  for (std::size_t k = 0; k < table.headings.size(); ++k) {
    if (by_option(k)) continue;
    const auto numbers = magnitudes_beside(sheet, table, k);
    if (!numbers) continue;
    const bool named_sign = names_sign(table.headings[k]), remark = may_name_sign(table.headings[k]);
    const SignCells cells = sign_cells_of(sheet, table, k, *numbers);
    const std::size_t read = cells.sizes + (remark ? cells.signs : 0);
    // A remark in few rows is about these rows, and signed numbers have their own signs.
    if (read == 0 || cells.others > 0 || (!named_sign && cells.signs > 0 && cells.sizes > 0)) {
      if (named_sign && cells.others > 0 && !has_negative(sheet, table, *numbers))
        refuse_unread_signs(sheet, table, k, *numbers);
      continue;
    }
    if (!named_sign && (cells.empty > read || has_negative(sheet, table, *numbers))) continue;
    if (cells.sizes > 0) refuse_both_sides(sheet, table, k, *numbers);
    apply(sheet, table, k, *numbers);
    sheet.notes.push_back(fmt::format("\"{}\" has the signs of \"{}\": the values get them",
                                      table.headings[k].text, table.headings[*numbers].text));
    if (named_sign) table.headings[k].name = "signs";
  }
  if (named.empty()) join_two_magnitudes(sheet, table);
}

}  // namespace vernier::importer
