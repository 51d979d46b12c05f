// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/words/title_units.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

#include "tools/format/units.h"
#include "tools/import/words/sheet_words.h"
#include "tools/sheet/unit_factor.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

/// What a part of a title is about.
enum class Quantity { kNone, kDeviation, kPosition, kValues, kOther };

struct Part {
  Quantity quantity = Quantity::kNone;
  bool all = false;  // "alle Werte"
  std::string text;
};

bool is_one_of(const std::string& word, std::initializer_list<std::string_view> list) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

bool starts_with_one_of(const std::string& word, std::initializer_list<std::string_view> list) {
  return std::any_of(list.begin(), list.end(), [&](std::string_view one) { return word.starts_with(one); });
}

/// `word`: small letters, without brackets and punctuation.
std::optional<Quantity> quantity_of(const std::string& word) {
  if (says_statistic(word)) return Quantity::kOther;
  if (says_deviation(word) || word.ends_with("abweichung") || word.ends_with("abweichungen") ||
      word.ends_with("fehler"))
    return Quantity::kDeviation;
  if (is_one_of(word, {"werte", "values", "angaben", "einheit", "einheiten", "unit", "units"}))
    return Quantity::kValues;
  if (word == "achse" || word == "axis") return std::nullopt;  // "Abweichungen der Achse X in µm"
  if (says_target(word) || starts_with_one_of(word, {"position", "sollwerte", "targets"}))
    return Quantity::kPosition;
  if (says_measured(word) ||
      starts_with_one_of(word, {"temp", "verfahrweg", "travel", "length", "l\u00e4nge", "step", "schritt",
                                "toleranz", "tolerance", "aufl\u00f6sung", "resolution", "unsicherheit",
                                "uncertainty", "grenz", "limit", "u=", "u95"}))
    return Quantity::kOther;
  return std::nullopt;
}

std::string bare(std::string word) {
  while (!word.empty() && (word.back() == ',' || word.back() == ';' || word.back() == '.')) word.pop_back();
  // A bracket of a whole phrase; "(µm)" keeps both of its own.
  const bool opens = word.find_first_of("([") != std::string::npos,
             closes = word.find_last_of(")]") != std::string::npos;
  if (opens && !closes) word.erase(0, word.find_first_not_of("(["));
  if (closes && !opens) word.erase(word.find_last_not_of(")]") + 1);
  return word;
}

std::vector<Part> parts_of(const std::string& title) {
  std::vector<Part> parts = {{}};
  bool all = false;
  for (const std::string& written : text::words_in(title, " \t;:")) {
    const std::string word = bare(written);
    // "Pos./Abw." has two quantities: the later one owns what follows.
    std::optional<Quantity> quantity;
    for (const std::string& piece : heading_words(text::in_small_letters(word)))
      if (const auto one = quantity_of(piece)) quantity = one;
    // "Error units: um" are the units of the errors.
    const bool of_quantity = quantity == Quantity::kValues && parts.back().quantity != Quantity::kNone &&
                             parts.back().quantity != Quantity::kValues &&
                             parts.back().text.find(' ') == std::string::npos;
    if (quantity && !of_quantity) parts.push_back({*quantity, all, ""});
    all = is_one_of(text::in_small_letters(word), {"alle", "aller", "all"});
    parts.back().text += (parts.back().text.empty() ? "" : " ") + word;
  }
  return parts;
}

/// Returns the first unit of lengths or angles in a part of a title, in a heading without name.
sheet::Heading unit_in(const std::string& part) {
  const std::vector<std::string> words = text::words_in(part, " \t");
  for (std::size_t k = 0; k < words.size(); ++k) {
    const std::string& word = words[k];
    const auto unit = sheet::unit_meant(word);
    // "in" and "as" are words of a sentence.
    if (!unit || word == "in" || word == "as" || word.size() < 2) continue;
    const auto dimension = format::find_unit(*unit)->dimension;
    if (dimension != format::Dimension::kLength && dimension != format::Dimension::kAngle) continue;
    // "Zehntel" before "µm" is no tenth of a millimetre, and the unit follows.
    std::size_t next = k + 1;
    while (next < words.size() && (words[next] == "of" || words[next] == "a" || words[next] == "an")) ++next;
    if (sheet::factor_at_end(word) && next < words.size() && sheet::unit_meant(words[next]) &&
        words[next] != "in")
      continue;
    std::string phrase;
    for (std::size_t i = 0; i <= k; ++i) phrase += (i == 0 ? "" : " ") + words[i];
    sheet::Heading heading = sheet::parse_heading(phrase);
    if (heading.unit.empty() && heading.unknown_unit.empty()) heading.unit = *unit;
    return heading;
  }
  return sheet::parse_heading(part);
}

bool has_unit(const sheet::Heading& heading) {
  return !heading.unit.empty() || !heading.unknown_unit.empty();
}

/// Returns the unit of the first quantity of the list that has one. Two parts of one quantity must not have
/// different units.
sheet::Heading unit_of(const std::vector<Part>& parts, std::initializer_list<Quantity> quantities,
                       bool only_all = false) {
  for (const Quantity quantity : quantities) {
    sheet::Heading found;
    for (const Part& part : parts) {
      if (part.quantity != quantity || (only_all && quantity == Quantity::kValues && !part.all)) continue;
      const sheet::Heading one = unit_in(part.text);
      if (!has_unit(one)) continue;
      if (has_unit(found) && (found.unit != one.unit || found.unknown_unit != one.unknown_unit)) return {};
      found = one;
    }
    if (has_unit(found)) return found;
  }
  return {};
}

void take(TitleUnit& known, const sheet::Heading& stated, const std::string& title, bool& contradicted) {
  if (stated.unit.empty()) return;
  contradicted |= !known.unit.empty() && known.unit != stated.unit;
  if (known.unit.empty()) known = {stated.unit, title};
}

}  // namespace

bool names_deviation(const std::string& title) {
  const std::vector<Part> parts = parts_of(title);
  return std::any_of(parts.begin(), parts.end(),
                     [](const Part& part) { return part.quantity == Quantity::kDeviation; });
}

sheet::Heading unit_of_deviations_in(const std::string& title) {
  const std::vector<Part> parts = parts_of(title);
  return names_deviation(title) ? unit_of(parts, {Quantity::kDeviation, Quantity::kNone, Quantity::kValues})
                                : unit_of(parts, {Quantity::kValues});
}

std::string note_of_title_unit(const char* of, const TitleUnit& unit) {
  return fmt::format("the unit of the {} is [{}], by the title \"{}\"; if this is wrong, give --unit", of,
                     unit.unit, unit.title);
}

namespace {

/// The cells above the headings; a unit alone is a part of the cell before it ("X axis error, um" in a file
/// with commas).
std::vector<std::string> titles_with_units(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  std::vector<std::string> titles = title_cells(sheet, table);
  for (std::size_t k = titles.size(); k-- > 1;)
    if (names_deviation(titles[k - 1]) && sheet::unit_meant(titles[k]) &&
        unit_of_deviations_in(titles[k - 1]).unit.empty()) {
      titles[k - 1] += ", " + titles[k];
      titles.erase(titles.begin() + static_cast<std::ptrdiff_t>(k));
    }
  return titles;
}

}  // namespace

TitleUnits units_of_titles(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  TitleUnits found;
  bool deviations = false, positions = false;  // contradictions
  for (const std::string& title : titles_with_units(sheet, table)) {
    take(found.deviations, unit_of_deviations_in(title), title, deviations);
    // "Units: mm  Error units: um": the unit of the values is that of the positions.
    const std::vector<Part> parts = parts_of(title);
    const bool apart = has_unit(unit_of(parts, {Quantity::kDeviation}));
    take(found.positions, unit_of(parts, {Quantity::kPosition, Quantity::kValues}, !apart), title, positions);
  }
  if (deviations) found.deviations = {};
  if (positions) found.positions = {};
  return found;
}

}  // namespace vernier::importer
