// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/words/unread_words.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <set>
#include <utility>

#include "tools/format/columns.h"
#include "tools/import/words/sheet_words.h"
#include "tools/import/words/sign_words.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

using WordSet = std::set<std::string, std::less<>>;

constexpr std::string_view kAxes = "xyzabcuvw";

bool is_number_word(std::string_view word) {
  return !word.empty() && word.find_first_not_of("0123456789") == std::string_view::npos;
}

/// "x", "x1", "j3", "dx", "xi": a letter of an axis, with the signs of ISO 230-2 beside it.
bool names_axis(const std::string& small) {
  const auto letter = [](char c) { return kAxes.find(c) != std::string_view::npos; };
  if (small.size() == 1) return letter(small[0]);
  for (const char* const delta : {"d", "\u0394", "\u03b4", "\u2206"})
    if (const std::string start = delta; small.starts_with(start) && small.size() == start.size() + 1)
      return letter(small.back());
  if (small.size() == 3 && small[0] == 'e') return letter(small[1]) && letter(small[2]);  // "EXX"
  if (small.size() > 3 || !(letter(small[0]) || small[0] == 'j')) return false;
  return is_number_word(small.substr(1)) || small.substr(1) == "i" || small.substr(1) == "ij";
}

/// Words without a meaning of their own in a heading.
bool is_empty_word(const std::string& small) {
  static const WordSet kWords = {"der",
                                 "die",
                                 "das",
                                 "des",
                                 "den",
                                 "dem",
                                 "von",
                                 "vom",
                                 "of",
                                 "the",
                                 "in",
                                 "bei",
                                 "at",
                                 "am",
                                 "an",
                                 "zu",
                                 "zur",
                                 "zum",
                                 "to",
                                 "und",
                                 "and",
                                 "für",
                                 "for",
                                 "je",
                                 "pro",
                                 "per",
                                 "im",
                                 "entlang",
                                 "along",
                                 "de",
                                 "du",
                                 "la",
                                 "le",
                                 "en",
                                 "et",
                                 "di",
                                 "del",
                                 "da",
                                 "wert",
                                 "werte",
                                 "value",
                                 "values",
                                 "val",
                                 "gegen",
                                 "vs",
                                 "axe",
                                 "linear",
                                 "koordinate",
                                 "coordinate",
                                 "einheit",
                                 "unit",
                                 "x\u0304",
                                 "richtung",
                                 "direction",
                                 "richtg",
                                 "ri",
                                 "anfahrrichtung",
                                 "verfahrrichtung",
                                 "fahrtrichtung",
                                 "messsystem",
                                 "messuhr",
                                 "uhr",
                                 "gauge",
                                 "dial",
                                 "iso",
                                 "din",
                                 "vdi",
                                 "e",
                                 "p"};
  return kWords.contains(small);
}

/// "positionsabweichung", "achsposition": two words in one, each of which a rule reads.
bool is_compound(const std::string& small) {
  static const WordSet kStarts = {
      "positions", "position", "positionier", "positionierungs", "längen", "winkel", "achs", "achsen",
      "mess",      "weg",      "lage",        "laser",           "soll",   "ist",    "ziel", "nenn",
      "maschinen"};
  return std::any_of(kStarts.begin(), kStarts.end(), [&](const std::string& start) {
    if (!small.starts_with(start) || small.size() == start.size()) return false;
    const std::string rest = small.substr(start.size());
    return says_deviation(rest) || says_target(rest) || says_measured(rest) || says_run(rest) ||
           is_empty_word(rest);
  });
}

bool is_read(const std::string& small, const HeadingPlace& place) {
  if (names_axis(small) || is_empty_word(small) || is_compound(small)) return true;
  if (says_target(small) || says_measured(small) || says_display(small) || says_deviation(small) ||
      says_correction(small) || says_straightness(small) || says_tilt(small) || says_counting(small) ||
      says_statistic(small) || says_run(small) || says_magnitude(small) || !role_said(small).empty())
    return true;
  const std::string sense = format::entry_of(format::AxisQuantity::kSense).prefix;
  if (small.starts_with(sense) && small.size() <= sense.size() + 1) return true;
  const format::ColumnGroup* const column = format::find_column(small);
  if (column != nullptr || (small.size() > 1 && sheet::unit_meant(small))) return true;
  if (sense_said(small) != 0 || says_way(small)) return place.run || !place.directed;
  const bool letter = small.size() == 1 && std::string_view("frhzvud").find(small) != std::string_view::npos;
  return says_state_of_correction(small) || (place.run && (letter || is_number_word(small)));
}

/// A heading without its units in brackets, and without "µm" at its end.
std::string without_units(std::string_view heading) {
  std::string text(heading);
  for (const auto& [open, close] : {std::pair('[', ']'), std::pair('(', ')'), std::pair('{', '}')})
    for (std::size_t at = text.find(open); at != std::string::npos; at = text.find(open, at + 1)) {
      const std::size_t end = text.find(close, at);
      if (end == std::string::npos) break;
      if (sheet::unit_meant(text.substr(at + 1, end - at - 1))) text.replace(at, end - at + 1, " ");
    }
  return text;
}

}  // namespace

std::vector<std::string> unread_words(std::string_view heading, const HeadingPlace& place) {
  std::string text = without_units(heading);
  for (const std::string_view dash : {"\u2212", "\u2010", "\u2011", "\u2013", "\u2014"})
    text::replace_all(text, dash, "-");
  for (const std::string_view index : {"_ij", "_i", "_j"})
    text::replace_all(text, index, "");    // of ISO 230-2
  text::replace_all(text, "\u00b7", " ");  // two bytes: as separators they would cut other letters
  for (const std::string arrow : {"\u2191", "\u2193", "\u2190", "\u2192"})
    text::replace_all(text, arrow, " " + arrow + " ");  // "1\u2191": a run and a direction
  std::vector<std::string> words;
  std::string alone;  // a sign alone before this word: "+ 10"
  const SignSaid sign = sign_said(heading, SignPlace::kHeading);
  // A word that a rule about the sign reads: without it the heading states another sign.
  const auto states_sign = [&](const std::string& word) {
    if (sign == SignSaid::kNothing) return false;
    std::string without(heading);
    const std::size_t at = without.find(word);
    if (at == std::string::npos) return false;
    return sign_said(without.erase(at, word.size()), SignPlace::kHeading) != sign;
  };
  for (const std::string& token : text::words_in(text, " \t,;:/()[]{}_.|#=\"'!?<>*")) {
    const bool sign_before = token.size() > 1 && (token[0] == '-' || token[0] == '+');
    bool first = true;
    const std::string before = std::exchange(alone, token == "+" || token == "-" ? token + " " : "");
    for (const std::string& part : text::words_in(token, "-+")) {
      const std::string small = text::in_small_letters(part);
      const bool signed_word =
          first && sign_before && !place.run && !is_number_word(small) && sign == SignSaid::kNothing;
      first = false;
      if (signed_word)
        words.push_back(token.substr(0, 1) + part);
      else if (!is_read(small, place) && !states_sign(part))
        words.push_back(is_number_word(small) ? before + part : part);
    }
  }
  return words;
}

std::vector<std::string> texts_beside_headings(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  std::vector<std::string> texts;
  if (!table.has_headings || table.heading_row >= sheet.rows.size()) return texts;
  const std::vector<std::string>& cells = sheet.rows[table.heading_row];
  bool behind = false;  // the cell before this one is a text
  for (std::size_t k = 0; k < cells.size(); ++k) {
    bool headed = false;
    for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
      headed |= k < sheet.rows[row].size() && !is_missing(sheet.rows[row][k]);
    if (headed || cells[k].empty()) {
      behind = false;
      continue;
    }
    if (behind) {
      texts.back() += ", " + cells[k];
    } else if (!unread_words(cells[k], {true, false}).empty()) {
      texts.push_back(cells[k]);
      behind = true;
    }
  }
  return texts;
}

bool is_telling_name(const std::string& sheet) {
  static const WordSet kUsual = {
      "tabelle",      "sheet",      "blatt",   "messung",   "daten",  "data",   "feuil",    "foglio",
      "hoja",         "messwerte",  "laser",   "messdaten", "table",  "werte",  "readings", "measurement",
      "measurements", "protokoll",  "achse",   "axis",      "axe",    "linear", "achsen",   "axes",
      "export",       "laserdaten", "results", "report",    "bericht"};
  for (const std::string& word : words_with_signs(text::in_small_letters(sheet))) {
    std::string bare = word;
    while (!bare.empty() && std::isdigit(static_cast<unsigned char>(bare.back())) != 0) bare.pop_back();
    for (const std::string& part : text::words_in(bare, "-+"))
      if (!kUsual.contains(part) && !names_axis(part) && !says_run(part) && sense_said(part) == 0 &&
          !says_way(part) && !is_empty_word(part))
        return true;
  }
  return false;
}

}  // namespace vernier::importer
