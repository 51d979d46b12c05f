// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/tables/run_signs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

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

/// The sign in a cell; kNone for another text.
Sign sign_in(const std::string& cell) {
  static const std::set<std::string> kPlus = {"+", "plus", "pos", "positiv", "positive"};
  static const std::set<std::string> kMinus = {"-",   "\u2212",  "\u2013",  "minus",
                                               "neg", "negativ", "negative"};
  const std::string small = text::in_small_letters(cell);
  return kPlus.contains(small) ? Sign::kPlus : kMinus.contains(small) ? Sign::kMinus : Sign::kNone;
}

bool names_sign(const sheet::Heading& heading) {
  static const std::set<std::string> kWords = {"vz", "vorz", "vorzeichen", "sign", "+/-", "\u00b1"};
  std::string small = text::in_small_letters(heading.text);
  while (small.ends_with('.')) small.pop_back();
  return kWords.contains(small);
}

void apply(sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t signs, std::size_t numbers) {
  const std::string &heading = table.headings[signs].text, &of = table.headings[numbers].text;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    std::string& cell = sheet.rows[row][numbers];
    const auto value = sheet::number_at(sheet, row, numbers);
    if (!value) continue;
    const Sign sign = sign_in(sheet.rows[row][signs]);
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
    sheet.rows[row][signs].clear();
  }
  sheet.notes.push_back(fmt::format("\"{}\" has the signs of \"{}\": the values get them", heading, of));
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
  for (std::size_t k = 0; table.has_headings && k + 1 < table.headings.size(); ++k) {
    const bool by_option = std::any_of(named.begin(), named.end(), [&](const std::string& option) {
      return option.find(table.headings[k].text) != std::string::npos;
    });
    if (by_option || !names_sign(table.headings[k])) continue;
    bool signs = false, others = false, numbers = false;
    for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
      const std::string& cell = sheet.rows[row][k];
      signs |= sign_in(cell) != Sign::kNone;
      others |= sign_in(cell) == Sign::kNone && !cell.empty();
      numbers |= sheet::number_at(sheet, row, k + 1).has_value();
    }
    if (!signs || others || !numbers) continue;
    apply(sheet, table, k, k + 1);
    table.headings[k].name = "signs";
  }
}

}  // namespace vernier::importer
