// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/words/title_units.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "tools/format/units.h"
#include "tools/import/words/sheet_words.h"
#include "tools/sheet/unit_factor.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

/// A word for what is measured: another quantity between the deviation and a unit owns the unit.
bool says_another_quantity(const std::string& word) {
  return says_target(word) || says_measured(word) || word.starts_with("position") || word == "pos" ||
         word.starts_with("temp") || word.starts_with("verfahrweg") || word.starts_with("travel") ||
         word.starts_with("length") || word.starts_with("l\u00e4nge") || word.starts_with("step") ||
         word.starts_with("schritt");
}

}  // namespace

bool names_deviation(const std::string& title) {
  const std::vector<std::string> words = heading_words(title);
  return std::any_of(words.begin(), words.end(),
                     [](const std::string& word) { return says_deviation(text::in_small_letters(word)); });
}

sheet::Heading unit_in_title(const std::string& title) {
  // A comma in a number is no comma of the sentence.
  const std::vector<std::string> parts = text::words_in(title, " \t;:");
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const std::string word = parts[k].ends_with(',') ? parts[k].substr(0, parts[k].size() - 1) : parts[k];
    const auto unit = sheet::unit_meant(word);
    // "in" and "as" are words of a sentence.
    if (!unit || word == "in" || word == "as" || word.size() < 2) continue;
    const auto dimension = format::find_unit(*unit)->dimension;
    if (dimension != format::Dimension::kLength && dimension != format::Dimension::kAngle) continue;
    // "Zehntel" before "µm" is no tenth of a millimetre, and the unit follows.
    std::size_t next = k + 1;
    while (next < parts.size() && (parts[next] == "of" || parts[next] == "a" || parts[next] == "an")) ++next;
    if (sheet::factor_at_end(word) && next < parts.size() && sheet::unit_meant(parts[next]) &&
        parts[next] != "in")
      continue;
    std::string phrase;
    for (std::size_t i = 0; i <= k; ++i) phrase += (i == 0 ? "" : " ") + (i == k ? word : parts[i]);
    sheet::Heading heading = sheet::parse_heading(phrase);
    if (heading.unit.empty() && heading.unknown_unit.empty()) heading.unit = *unit;
    return heading;
  }
  return sheet::parse_heading(title);
}

TitleUnit unit_of_deviations(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  TitleUnit found;
  for (const std::string& title : title_cells(sheet, table)) {
    const std::vector<std::string> words = text::words_in(title, " \t");
    std::string behind;
    bool named = false;
    for (const std::string& word : words) {
      const std::string small = text::in_small_letters(word);
      const bool starts = names_deviation(word);
      if (starts) {
        named = true;
        behind = "";
      }
      const std::vector<std::string> parts = heading_words(small);
      if (!starts && named && std::any_of(parts.begin(), parts.end(), says_another_quantity)) {
        // A unit before this word belongs to the deviations.
        const sheet::Heading before = unit_in_title("x " + behind);
        if (before.unit.empty()) behind = "";
        break;
      }
      if (named) behind += (behind.empty() ? "" : " ") + word;
    }
    if (behind.empty()) continue;
    const std::string unit = unit_in_title(behind).unit;
    if (unit.empty()) continue;
    if (!found.unit.empty() && found.unit != unit) return {};
    if (found.unit.empty()) found = {unit, title};
  }
  return found;
}

}  // namespace vernier::importer
