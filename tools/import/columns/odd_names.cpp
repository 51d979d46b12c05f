// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/columns/odd_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "tools/format/columns.h"
#include "tools/import/words/sheet_words.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

/// A name of a run or a point, and the rows that have it.
struct RowName {
  std::string text;
  std::size_t rows = 0;
  std::set<std::string> words;  // that no rule reads, in small letters; marks are words too
  bool odd = false;
};

/// True for a letter and for each byte of one beyond ASCII.
bool is_letter(char c) {
  constexpr unsigned char kBeyondAscii = 0x80;
  const auto byte = static_cast<unsigned char>(c);
  return std::isalpha(byte) != 0 || byte >= kBeyondAscii;
}

/// The words of a name beside numbers, single letters, directions and words for runs, and its marks.
std::set<std::string> words_of_name(const std::string& name) {
  constexpr std::string_view kMarks = "*?!()~#<>=";
  std::set<std::string> words;
  std::string word;
  const auto end_word = [&] {
    const std::string one = std::exchange(word, "");
    if (one.size() < 2 || says_run(one) || sense_said(one) != 0 || says_way(one)) return;
    words.insert(one);
  };
  for (const char c : text::in_small_letters(name)) {
    if (is_letter(c)) {
      word += c;
      continue;
    }
    end_word();
    if (kMarks.find(c) != std::string_view::npos) words.insert(std::string(1, c));
  }
  end_word();
  return words;
}

/// True for a word of a run before the measurement.
bool says_trial(const std::string& word) {
  static constexpr std::array<std::string_view, 12> kTrials = {"probe",    "probelauf", "test",    "testlauf",
                                                               "warmlauf", "einfahren", "einlauf", "vorlauf",
                                                               "warmup",   "trial",     "dry",     "dryrun"};
  return std::find(kTrials.begin(), kTrials.end(), word) != kTrials.end();
}

std::vector<RowName> names_of_column(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                     std::size_t k) {
  std::vector<RowName> names;
  std::map<std::string, std::size_t> place;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    if (k >= sheet.rows[row].size() || is_missing(sheet.rows[row][k])) continue;
    const std::string& cell = sheet.rows[row][k];
    const auto [at, is_new] = place.emplace(cell, names.size());
    if (is_new) names.push_back({cell, 0, words_of_name(cell), false});
    ++names[at->second].rows;
  }
  return names;
}

/// A word in half of the names is a part of their form ("Serie 1", "Serie 2", "Serie 3").
void mark_odd(std::vector<RowName>& names) {
  std::map<std::string, std::size_t> count;
  for (const RowName& name : names)
    for (const std::string& word : name.words) ++count[word];
  std::size_t odd = 0;
  for (RowName& name : names) {
    name.odd = std::any_of(name.words.begin(), name.words.end(), [&](const std::string& word) {
      return 2 * count[word] < names.size() || (names.size() == 2 && count[word] == 1);
    });
    odd += name.odd ? 1 : 0;
  }
  if (2 * odd <= names.size()) return;
  std::size_t trials = 0;  // the names have no common form
  for (RowName& name : names) {
    name.odd = std::any_of(name.words.begin(), name.words.end(), says_trial);
    trials += name.odd ? 1 : 0;
  }
  for (RowName& name : names) name.odd &= trials < names.size();
}

/// True for a column with the names of runs or points.
bool has_names(const sheet::Heading& heading, const SheetColumn& column) {
  if (column.use != SheetColumn::Use::kColumn) return false;
  if (column.name == format::columns::kRun || column.name == format::columns::kSetup) return true;
  return column.unit.empty() && heads_counting(heading.text);
}

}  // namespace

void note_odd_names(sheet::Sheet& sheet, const sheet::SheetTable& table,
                    const std::vector<SheetColumn>& columns) {
  constexpr std::size_t kShown = 4;  // names of one column
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (!has_names(table.headings[k], columns[k])) continue;
    std::vector<RowName> names = names_of_column(sheet, table, k);
    mark_odd(names);
    std::string odd, others;
    std::size_t count = 0, usual = 0;
    for (const RowName& name : names) {
      const bool quoted = std::any_of(sheet.notes.begin(), sheet.notes.end(), [&](const std::string& note) {
        return note.find("\"" + name.text + "\"") != std::string::npos;
      });
      if (!name.odd && ++usual <= kShown) others += (others.empty() ? "" : ", ") + name.text;
      if (!name.odd || quoted || ++count > kShown) continue;
      odd += fmt::format("{}\"{}\" in {} row{}", odd.empty() ? "" : ", ", name.text, name.rows,
                         name.rows == 1 ? "" : "s");
    }
    if (count == 0) continue;
    if (count > kShown) odd += fmt::format(" and {} more", count - kShown);
    if (usual > kShown) others += ", ...";
    sheet.notes.push_back(
        fmt::format("column \"{}\": {} (the others: {}). Are these rows valid readings? They are read like "
                    "the others: if not, delete them in the file",
                    table.headings[k].text, odd, others));
  }
}

}  // namespace vernier::importer
