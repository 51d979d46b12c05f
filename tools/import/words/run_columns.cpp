// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/words/run_columns.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <set>
#include <string_view>
#include <vector>

#include "tools/import/words/sheet_words.h"
#include "tools/import/words/sign_words.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

enum class Piece { kNone, kNumber, kWord, kSign };

struct RunToken {
  Piece piece = Piece::kNone;
  std::string text;
  bool glued = false;  // to the piece before it, without a blank or point between
};

constexpr std::string_view kArrows[] = {"\u2191", "\u2193", "\u2190", "\u2192", "\u2212", "\u2013"};

Piece piece_of(char c) {
  const auto letter = static_cast<unsigned char>(c);
  if (std::isdigit(letter) != 0) return Piece::kNumber;
  if (std::isalpha(letter) != 0 || letter >= 0x80) return Piece::kWord;
  return c == '+' || c == '-' ? Piece::kSign : Piece::kNone;
}

/// Numbers, words and signs of a heading.
std::vector<RunToken> run_tokens_of(const std::string& name) {
  std::vector<RunToken> tokens;
  bool glued = false;
  for (std::size_t at = 0; at < name.size();) {
    RunToken token;
    token.glued = glued;
    for (const std::string_view arrow : kArrows)
      if (name.compare(at, arrow.size(), arrow) == 0) token = {Piece::kSign, std::string(arrow), glued};
    if (token.piece == Piece::kNone) {
      token.piece = piece_of(name[at]);
      token.text = name[at];
      const auto arrow_at = [&](std::size_t place) {
        return std::any_of(std::begin(kArrows), std::end(kArrows), [&](std::string_view arrow) {
          return name.compare(place, arrow.size(), arrow) == 0;
        });
      };
      if (token.piece == Piece::kNumber || token.piece == Piece::kWord)
        while (at + token.text.size() < name.size() &&
               piece_of(name[at + token.text.size()]) == token.piece && !arrow_at(at + token.text.size()))
          token.text += name[at + token.text.size()];
    }
    at += token.text.size();
    glued = token.piece != Piece::kNone;
    if (glued) tokens.push_back(std::move(token));
  }
  return tokens;
}

/// A direction against gravity, which is not always that of increasing positions.
bool says_height(const std::string& word) {
  static const std::set<std::string> kHeights = {"up",        "down",    "auf",      "ab",
                                                 "aufwärts",  "abwärts", "upward",   "downward",
                                                 "aufwaerts", "upwards", "abwaerts", "downwards"};
  return kHeights.contains(word);
}

/// A heading of a run may have a mark in place of a word: "Nr 1", "M1", "Test 1".
bool marks_run(const std::string& word) {
  static const std::set<std::string> kMarks = {"runs", "test", "nr", "no", "r", "m", "mr", "n"};
  return says_run(word) || kMarks.contains(word);
}

/// A sign between a word and the next word joins them ("Lauf-1"), else it is a direction.
bool joins(const std::vector<RunToken>& tokens, std::size_t k) {
  if (tokens[k].text != "-" && tokens[k].text != "\u2013") return false;
  const bool behind = k > 0 && tokens[k].glued, before = k + 1 < tokens.size() && tokens[k + 1].glued;
  return behind && before;
}

/// The name with the minus behind it, which parse_heading takes for a stroke before the unit: "1- [um]",
/// "1-/um".
std::string with_its_sign(const sheet::Heading& heading) {
  if (!heading.text.starts_with(heading.name)) return heading.name;
  const std::string rest = text::trimmed(heading.text.substr(heading.name.size()));
  const bool minus =
      rest.starts_with("-") && (rest.size() == 1 || std::string_view(" [(/").find(rest[1]) != rest.npos);
  return heading.name + (minus ? " -" : "");
}

}  // namespace

std::optional<RunColumn> run_column(const sheet::Heading& heading) {
  RunColumn column;
  column.unit = heading.unit;
  const SignSaid sign = sign_said(heading.text, SignPlace::kHeading);
  if (sign == SignSaid::kUnclear) return std::nullopt;
  column.turned = sign == SignSaid::kNominalLessActual;
  column.length = sign != sign_said(heading.text, SignPlace::kHeading, Travel::kBothSides);
  std::string name = with_its_sign(heading);
  if (sign != SignSaid::kNothing) {  // the text in brackets gives the sign only
    const auto open = name.find_first_of("(["), close = name.find_last_of(")]");
    if (open == std::string::npos || close == std::string::npos || close < open) return std::nullopt;
    name.erase(open, close - open + 1);
    column.deviation = true;
  }
  const std::vector<RunToken> tokens = run_tokens_of(name);
  int by_word = 0, by_sign = 0;
  bool said = false;
  for (std::size_t k = 0; k < tokens.size(); ++k) {
    const RunToken& token = tokens[k];
    const std::string small = text::in_small_letters(token.text);
    if (token.piece == Piece::kNumber) {
      if (!column.run.empty() || token.text.size() > 3) return std::nullopt;
      column.run = token.text;
    } else if (token.piece == Piece::kSign) {
      if (!joins(tokens, k)) by_sign = token.text == "\u2013" ? -1 : sense_said(token.text);
      column.relative |= token.text == "\u2191" || token.text == "\u2193";
    } else if (marks_run(small)) {
      said = true;
    } else if (sense_said(small) != 0) {
      if (by_word != 0) return std::nullopt;
      by_word = sense_said(small);
      column.relative |= says_way(small) || says_height(small);
      column.forth |= says_way(small);
      column.pos |= small == "pos";
    } else if (says_deviation(small)) {
      column.deviation = said = true;
    } else if (says_measured(small)) {
      column.measured = said = true;
    } else if (token.text.size() == 1 &&
               std::string_view("XYZABCUVW").find(token.text[0]) != std::string_view::npos &&
               column.axis.empty() &&
               (k + 1 >= tokens.size() || !tokens[k + 1].glued || tokens[k + 1].piece == Piece::kSign)) {
      column.axis = token.text;
    } else {
      return std::nullopt;
    }
  }
  column.sense = by_word != 0 ? by_word : by_sign;
  if (column.run.empty() && column.sense == 0) return std::nullopt;
  if (column.sense == 0 && !said) return std::nullopt;
  return column;
}

std::pair<int, sheet::Heading> position_of_direction(const sheet::Heading& heading) {
  int sense = 0;
  bool target = false;
  std::string name;
  // "X+" is one word here.
  for (const std::string& written : words_with_signs(heading.name)) {
    const std::string small = text::in_small_letters(written);
    const bool of_axis = is_axis_direction(written);
    const bool rises =
        !says_target(small) && !is_run_number(small) && sense_said(small) != 0 && small.size() > 2;
    if (says_way(small) || of_axis || rises) {
      if (sense != 0) return {0, heading};
      sense = sense_said(small);
      if (!of_axis) continue;
    }
    const std::string word = of_axis ? written.substr(0, 1) : written;
    target |= says_target(small) ||
              (word.size() == 1 && std::string_view("XYZABCUVW").find(word[0]) != std::string_view::npos);
    name += (name.empty() ? "" : " ") + word;
  }
  if (!target || sense == 0) return {0, heading};
  return {sense, {name, name, heading.unit, heading.unknown_unit}};
}

}  // namespace vernier::importer
