// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/distances/pair_names.h"

#include <algorithm>
#include <array>
#include <set>

#include "tools/text/words.h"

namespace vernier::importer {
namespace {

using WordSet = std::set<std::string, std::less<>>;

bool is_name_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }
bool is_name_digit(char c) { return c >= '0' && c <= '9'; }
bool is_of_utf8(char c) { return static_cast<unsigned char>(c) >= 0x80; }

/// Verdicts and marks that look like two letters.
bool is_short_verdict(const std::string& cell) {
  static const WordSet kVerdicts = {"OK", "NO", "IO", "NA", "NOK", "NIO", "JA", "ON", "CW"};
  return kVerdicts.contains(cell);
}

/// A name of a point: letters, digits, blanks and a few signs, at least one letter or digit.
bool is_point_name(const std::string& name, bool sure) {
  constexpr std::size_t kLongest = 32;  // bytes: "hinten rechts oben"
  constexpr std::size_t kShort = 5;     // "P12", "VL", "E10": without a heading that says so
  if (name.empty() || name.size() > (sure ? kLongest : kShort)) return false;
  bool any = false;
  for (const char c : name) {
    const bool good = is_name_letter(c) || is_name_digit(c) || is_of_utf8(c);
    if (!good && (!sure || (c != ' ' && c != '_' && c != '\'' && c != '.' && c != '#'))) return false;
    any |= good;
  }
  // "0.5" is a number; "X+" and "Lauf1" without a heading of pairs are no points.
  if (name.find('.') != std::string::npos && is_name_digit(name.front())) return false;
  if (sure) return any;
  constexpr std::ptrdiff_t kLetters = 2, kDigits = 3;  // four digits are a year
  return std::count_if(name.begin(), name.end(), is_name_letter) <= kLetters &&
         std::count_if(name.begin(), name.end(), is_name_digit) <= kDigits &&
         std::none_of(name.begin(), name.end(), is_of_utf8);
}

/// The known name that a word means; letters in another case are the same name if only one name has them.
std::string as_known(const std::string& word, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), word) != known.end()) return word;
  std::string found;
  for (const std::string& name : known)
    if (text::in_small_letters(name) == text::in_small_letters(word)) {
      if (!found.empty()) return word;
      found = name;
    }
  return found.empty() ? word : found;
}

bool is_known(const std::string& word, const std::vector<std::string>& known) {
  return std::find(known.begin(), known.end(), as_known(word, known)) != known.end();
}

/// The text without a bracket behind it, without the sign of a length around it, and without the word of a
/// length before it: "|AC|", "Diagonale AC (lang)", "AC:" are "AC".
std::string bare(const std::string& cell) {
  std::string word = text::trimmed(cell);
  text::replace_all(word, "\u0305", "");
  text::replace_all(word, "|", "");
  for (const auto& [open, close] : {std::pair('(', ')'), std::pair('[', ']')})
    if (word.ends_with(close) && word.find(open) != std::string::npos && word.find(open) > 0)
      word = text::trimmed(word.substr(0, word.rfind(open)));
  while (!word.empty() && (word.back() == ':' || word.back() == '=')) word.pop_back();
  word = text::trimmed(word);
  const std::size_t blank = word.find(' ');
  if (blank != std::string::npos && names_a_length(text::in_small_letters(word.substr(0, blank))))
    word = text::trimmed(word.substr(blank));
  return word;
}

/// Both parts of a word at a sign that stands once in it, or in its middle.
std::optional<PointPair> parted(const std::string& word, std::string_view sign) {
  std::vector<std::size_t> at;
  for (std::size_t found = word.find(sign); found != std::string::npos;
       found = word.find(sign, found + sign.size()))
    at.push_back(found);
  if (at.size() % 2 == 0) return std::nullopt;
  const std::size_t middle = at[at.size() / 2];
  return PointPair{text::trimmed(word.substr(0, middle)), text::trimmed(word.substr(middle + sign.size()))};
}

/// Two names without a sign between them.
std::optional<PointPair> joined_names(const std::string& word, const std::vector<std::string>& known,
                                      bool sure) {
  std::optional<PointPair> found;
  for (std::size_t at = 1; at < word.size(); ++at) {
    const PointPair pair{word.substr(0, at), word.substr(at)};
    if (!is_known(pair.first, known) || !is_known(pair.second, known)) continue;
    if (found) return std::nullopt;  // "1" and "12", or "11" and "2"
    found = pair;
  }
  if (found) return found;
  const auto all = [&](auto is) { return std::all_of(word.begin(), word.end(), is); };
  const bool capitals = all([](char c) { return c >= 'A' && c <= 'W'; });
  const bool small = sure && all([](char c) { return c >= 'a' && c <= 'z'; });
  const bool digits = sure && all([](char c) { return c >= '1' && c <= '9'; });
  if (word.size() == 2 && (capitals || small || digits)) return PointPair{word.substr(0, 1), word.substr(1)};
  // "VLHR": two names of two letters; "P1P2": a letter and its number, twice.
  constexpr std::size_t kTwoOfTwo = 4;
  if (sure && word.size() == kTwoOfTwo && capitals) return PointPair{word.substr(0, 2), word.substr(2)};
  const auto second = std::find_if(word.begin() + (word.empty() ? 0 : 1), word.end(), is_name_letter);
  const std::string first_name(word.begin(), second), second_name(second, word.end());
  const auto numbered = [](const std::string& name) {
    return name.size() > 1 && is_name_letter(name.front()) &&
           std::all_of(name.begin() + 1, name.end(), is_name_digit);
  };
  if (numbered(first_name) && numbered(second_name) && first_name.front() == second_name.front())
    return PointPair{first_name, second_name};
  return std::nullopt;
}

}  // namespace

bool names_a_length(const std::string& word) {
  static const WordSet kLengths = {
      "strecke",     "strecken",     "seite",   "seiten",    "diagonale",   "diagonalen", "diagonal",
      "diag",        "diag.",        "side",    "sides",     "distance",    "distances",  "abstand",
      "abstände",    "kante",        "kanten",  "edge",      "edges",       "länge",      "length",
      "linie",       "line",         "pair",    "pairs",     "paar",        "paare",      "segment",
      "messstrecke", "messstrecken", "dist",    "distanz",   "punkte",      "points",     "from-to",
      "von-nach",    "zwischen",     "between", "punktpaar", "eckpunkte",   "ecken",      "corners",
      "maß",         "mass",         "maße",    "dimension", "bezeichnung", "merkmal",    "feature",
      "name",        "von/nach",     "from/to"};
  return kLengths.contains(word);
}

bool heads_end_of_pair(const std::string& heading, bool first) {
  static const WordSet kFirst = {
      "von",        "from",        "start",    "anfang", "ab",       "begin",   "punkt 1",  "punkt1",
      "point 1",    "point1",      "p1",       "ecke 1", "corner 1", "punkt a", "point a",  "erster punkt",
      "startpunkt", "start point", "1. punkt", "pkt 1",  "pkt. 1",   "de",      "von punkt"};
  static const WordSet kSecond = {
      "nach",     "to",        "ende",     "end",    "bis",      "zu",      "punkt 2",   "punkt2",
      "point 2",  "point2",    "p2",       "ecke 2", "corner 2", "punkt b", "point b",   "zweiter punkt",
      "endpunkt", "end point", "2. punkt", "pkt 2",  "pkt. 2",   "à",       "nach punkt"};
  return (first ? kFirst : kSecond).contains(text::in_small_letters(text::trimmed(heading)));
}

std::optional<PointPair> two_points(const std::string& cell, const std::vector<std::string>& known,
                                    bool sure) {
  const std::string word = bare(cell);
  if (word.size() < 2 || is_short_verdict(word)) return std::nullopt;
  const auto checked = [&](std::optional<PointPair> pair) -> std::optional<PointPair> {
    if (!pair) return std::nullopt;
    pair->first = as_known(pair->first, known);
    pair->second = as_known(pair->second, known);
    if (pair->first == pair->second) return std::nullopt;
    for (const std::string& name : {pair->first, pair->second})
      if (!is_known(name, known) && !is_point_name(name, sure)) return std::nullopt;
    return pair;
  };
  // The longer signs first: " - " may stand between names with "-" of their own.
  static constexpr std::array<std::string_view, 23> kSigns = {
      "<->",      "->",    "=>",     "\u2192", "\u27f6", "\u2194", "\u21d2", " \u2013 ",
      " \u2014 ", " - ",   "\u2013", "\u2014", "\u2212", "\u2010", "\u2011", " nach ",
      " to ",     " bis ", " und ",  " and ",  "/",      "-",      ".."};
  for (const std::string_view sign : kSigns)
    if (word.find(sign) != std::string::npos)
      if (const auto pair = checked(parted(word, sign))) return pair;
  if (const auto pair = checked(joined_names(word, known, sure))) return pair;
  const auto pair = checked(parted(word, " "));
  // "Teil 1" is the name of one thing: without a heading of pairs, both names have the same form.
  if (pair && (sure || pair->first.size() == pair->second.size())) return pair;
  return std::nullopt;
}

bool names_two_points(const std::string& cell) {
  const auto pair = two_points(cell, {}, false);
  const auto letter = [](const std::string& name) {
    return name.size() == 1 && name.front() >= 'A' && name.front() <= 'W';
  };
  return pair && letter(pair->first) && letter(pair->second);
}

}  // namespace vernier::importer
