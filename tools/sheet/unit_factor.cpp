// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/sheet/unit_factor.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "tools/format/units.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::sheet {
namespace {

constexpr std::array<std::pair<std::string_view, double>, 22> kFactorWords = {{
    {"zehntel", 0.1},
    {"zehntels", 0.1},
    {"10tel", 0.1},
    {"tenth", 0.1},
    {"tenths", 0.1},
    {"hundertstel", 0.01},
    {"hunderstel", 0.01},
    {"100stel", 0.01},
    {"hundredth", 0.01},
    {"hundredths", 0.01},
    {"tausendstel", 0.001},
    {"tausenstel", 0.001},
    {"1000stel", 0.001},
    {"thousandth", 0.001},
    {"thousandths", 0.001},
    {"zehntausendstel", 1e-4},
    {"ten-thousandth", 1e-4},
    {"ten-thousandths", 1e-4},
    {"hundred-thousandths", 1e-5},
    {"millionstel", 1e-6},
    {"millionths", 1e-6},
    {"halbe", 0.5},
}};

/// A word of a text in small letters, without brackets around it.
struct Word {
  std::size_t begin = 0;
  std::string text;
};

std::vector<Word> words_of(std::string_view text) {
  const auto parts = [](char c) {
    return std::string_view(" \t\n\r()[]{}<>").find(c) != std::string_view::npos;
  };
  std::vector<Word> words;
  for (std::size_t at = 0; at < text.size();) {
    if (parts(text[at])) {
      ++at;
      continue;
    }
    std::size_t end = at;
    while (end < text.size() && !parts(text[end])) ++end;
    words.push_back({at, text::in_small_letters(text.substr(at, end - at))});
    if (text[at] == 'X') words.back().text[0] = 'X';  // an axis, no sign of multiplication
    at = end;
  }
  return words;
}

bool is_whole(std::string_view text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// Length of the sign of multiplication at the beginning of a word: x, * or a cross.
std::size_t times_length(std::string_view word) {
  if (word.starts_with('x') || word.starts_with('*')) return 1;
  constexpr std::string_view kCross = "\u00d7";
  return word.starts_with(kCross) ? kCross.size() : 0;
}

bool is_times(std::string_view word) { return !word.empty() && times_length(word) == word.size(); }

/// Removes a sign of multiplication before a number: "x1000".
bool take_times(std::string& word) {
  const std::size_t length = times_length(word);
  if (length == 0 || word.size() == length ||
      std::string_view("0123456789.,").find(word[length]) == std::string_view::npos)
    return false;
  word.erase(0, length);
  return true;
}

bool says_division(std::string word) {
  while (!word.empty() && (word.back() == '.' || word.back() == ':')) word.pop_back();
  static const std::set<std::string> kWords = {"skt",         "teilstrich", "teilstriche", "teilstrichen",
                                               "skalenteile", "skalenteil", "division",    "divisions",
                                               "div",         "teilung"};
  return kWords.contains(word);
}

/// Words between a factor and its unit, and between a word for divisions and their size.
bool joins(const std::string& word) {
  static const std::set<std::string> kWords = {"of",  "a",   "an", "je",     "von",
                                               "pro", "per", "=",  "\u00e0", "eines"};
  return kWords.contains(word);
}

/// "Lauf 1/10": the first run of ten.
bool counts(std::string word) {
  while (!word.empty() && (word.back() == '.' || word.back() == ':')) word.pop_back();
  static const std::set<std::string> kWords = {"lauf",  "run",   "messung", "messreihe", "messlauf", "pass",
                                               "nr",    "no",    "zyklus",  "cycle",     "pos",      "punkt",
                                               "point", "serie", "series",  "durchgang", "reihe",    "test"};
  return kWords.contains(word);
}

/// "X" in "Abweichung X 2 um".
bool is_axis_letter(std::string_view text, const Word& word) {
  return word.text.size() == 1 && std::isupper(static_cast<unsigned char>(text[word.begin])) != 0;
}

/// The value of one word; 0: a factor that is not clear. Whole numbers count only if `number` is true.
std::optional<double> value_of(std::string word, bool number) {
  while (word.size() > 1 && (word.back() == '-' || word.back() == ':')) word.pop_back();
  for (const auto& [text, value] : kFactorWords)
    if (word == text) return value;
  if (word.starts_with("1/") && is_whole(word.substr(2))) {
    const double parts = *text::parse_number(word.substr(2));
    return parts > 1 ? std::optional(1 / parts) : std::nullopt;
  }
  for (const std::string_view power : {"10^-", "10-", "10^\u2212", "10\u2212", "1e-"})
    if (word.starts_with(power) && word.size() == power.size() + 1 && is_whole(word.substr(power.size())))
      return std::pow(10.0, -static_cast<double>(word.back() - '0'));
  // 10e-3 is 0.01, and people who write it mean 0.001.
  for (const std::string_view power : {"10^", "10e", "e-", "10\u207b"})
    if (word.starts_with(power) && word.size() > power.size()) return 0.0;
  std::replace(word.begin(), word.end(), ',', '.');
  if (word.starts_with('.')) word.insert(0, "0");
  if (word.empty() || std::isdigit(static_cast<unsigned char>(word.front())) == 0) return std::nullopt;
  const auto value = text::parse_number(word);
  if (!value || *value <= 0 || *value == 1 || (*value > 1 && !number)) return std::nullopt;
  return *value;
}

}  // namespace

std::optional<UnitFactor> factor_at_end(std::string_view text, bool bare) {
  const std::vector<Word> words = words_of(text);
  std::size_t end = words.size();
  while (end > 1 && joins(words[end - 1].text)) --end;
  if (end == 0) return std::nullopt;
  std::size_t begin = end - 1;
  if (says_division(words[begin].text)) return UnitFactor{words[begin].begin, 0};
  std::string word = words[begin].text;
  bool times = take_times(word);
  if (begin > 1 && words[begin - 1].text == "/" && words[begin - 2].text == "1") {
    begin -= 2;
    word.insert(0, "1/");
  }
  // What stands before it: a sign of multiplication, and the word for divisions.
  if (!times && begin > 0 && is_times(words[begin - 1].text) &&
      std::isdigit(static_cast<unsigned char>(word[0])) != 0) {
    times = true;
    --begin;
  }
  std::size_t before = begin;
  while (before > 0 && joins(words[before - 1].text)) --before;
  const bool division = before > 0 && says_division(words[before - 1].text);
  const bool in = begin > 0 && words[begin - 1].text == "in";
  const bool after_axis = begin > 1 && bare && is_axis_letter(text, words[begin - 1]);
  const auto value = value_of(word, times || division || in || after_axis);
  if (!value) return std::nullopt;
  if (begin > 0 && !times && !division && (words[begin - 1].text == "=" || counts(words[begin - 1].text)))
    return std::nullopt;
  UnitFactor factor{words[begin].begin, *value};
  if (division) {
    factor.begin = words[before - 1].begin;
    if (before > 1 && words[before - 2].text == "1") factor.begin = words[before - 2].begin;
  }
  // "Zehntel von 1/100": more than one factor.
  if (begin > 0 && !division && value_of(words[begin - 1].text, false)) factor = {words[begin - 1].begin, 0};
  // "(Messuhr 1/100) [mm]" may name the instrument only.
  const std::size_t start = text.find_last_not_of(" \t", factor.begin - (factor.begin > 0 ? 1 : 0));
  const bool opened = factor.begin == 0 || (start != std::string_view::npos && text[start] == '(');
  if (text.substr(factor.begin).find(')') != std::string_view::npos && !opened) factor.value = 0;
  // The sign of multiplication says how the values were multiplied, or how they have to be.
  if ((times || (after_axis && !in)) && *value > 1) factor.value = 0;
  return factor;
}

std::optional<UnitFactor> factor_behind(std::string_view text) {
  const std::vector<Word> words = words_of(text);
  if (words.empty() || words.size() > 3) return std::nullopt;
  const bool times = is_times(words[0].text);
  if (times && words.size() == 2 && value_of(words[1].text, true)) return UnitFactor{words[0].begin, 0};
  const std::size_t first = words[0].text == "in" ? 1 : 0;
  if (words.size() != first + 1) return std::nullopt;
  std::string word = words[first].text;
  if (take_times(word) || (word.size() > 1 && word[0] == '/' && is_whole(word.substr(1))))
    return UnitFactor{words[0].begin, 0};
  if (says_division(word)) return UnitFactor{words[0].begin, 0};
  const auto value = value_of(word, false);
  if (!value) return std::nullopt;
  // "[mm] 1/2" counts measurements.
  const double power = *value > 0 ? std::log10(*value) : 0;
  if (word.starts_with("1/") && std::abs(power - std::round(power)) > 1e-9) return std::nullopt;
  return UnitFactor{words[0].begin, *value};
}

bool names_factor(std::string_view text) {
  const std::vector<Word> words = words_of(text);
  return std::any_of(words.begin(), words.end(),
                     [](const Word& word) { return says_division(word.text) || value_of(word.text, false); });
}

bool has_factor(std::string_view unit) {
  return unit.find_first_of("0123456789") != std::string_view::npos || names_factor(unit);
}

std::optional<std::string> unit_times(double factor, std::string_view unit) {
  const auto whole = format::find_unit(unit);
  if (!whole || factor <= 0 || whole->offset != 0) return std::nullopt;
  const double size = factor * whole->factor;
  for (const std::string& name : format::units_of(whole->dimension)) {
    const auto found = format::find_unit(name);
    if (found->offset == 0 && std::abs(found->factor - size) <= 1e-9 * size) return name;
  }
  return std::nullopt;
}

}  // namespace vernier::sheet
