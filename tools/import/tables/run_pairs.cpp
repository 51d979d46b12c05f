// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/tables/run_pairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <map>
#include <optional>
#include <string>

#include "tools/import/words/sheet_words.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

struct DirectionPair {
  const char *forth, *back;          // in headings, in small letters
  const char *say_forth, *say_back;  // words that every heading of a run may have
};
constexpr const char *kForth = "hin", *kBack = "zurück", *kUp = "up", *kDown = "down";
constexpr DirectionPair kDirectionPairs[] = {
    {"v", "r", kForth, kBack}, {"h", "z", kForth, kBack},  // vor, rück; hin, zurück
    {"h", "r", kForth, kBack}, {"f", "b", kForth, kBack},  // hin, rück; forward, back
    {"f", "r", kForth, kBack},                             // forward, reverse
    {"a", "r", kForth, kBack},                             // aller, retour; andata, ritorno
    {"i", "v", kForth, kBack},                             // ida, vuelta
    {"up", "dn", kUp, kDown}};

/// A heading of one number and of words, in any order, with blanks, points or low lines between.
struct Parts {
  std::string word, number;
};

std::optional<Parts> parts_of(const std::string& name) {
  Parts parts;
  for (std::size_t at = 0; at < name.size();) {
    const auto is_digit = [&](std::size_t k) {
      return std::isdigit(static_cast<unsigned char>(name[k])) != 0;
    };
    const auto is_letter = [&](std::size_t k) {
      return std::isalpha(static_cast<unsigned char>(name[k])) != 0;
    };
    const std::size_t begin = at;
    if (is_digit(at))
      while (at < name.size() && is_digit(at)) ++at;
    else if (is_letter(at))
      while (at < name.size() && is_letter(at)) ++at;
    else if (std::string_view(" ._").find(name[at++]) != std::string_view::npos)
      continue;
    else
      return std::nullopt;
    if (is_digit(begin) && !parts.number.empty()) return std::nullopt;
    (is_digit(begin) ? parts.number : parts.word) += text::in_small_letters(name.substr(begin, at - begin));
  }
  if (!is_run_number(parts.number) || parts.word.empty()) return std::nullopt;
  return parts;
}

/// Columns of one word, by the number of the run.
using Family = std::map<std::string, std::size_t>;

bool same_runs(const sheet::SheetTable& table, const Family& forth, const Family& back) {
  constexpr std::size_t kFewest = 2;  // one letter with one number is no series of runs
  if (forth.size() < kFewest || forth.size() != back.size()) return false;
  const std::string& unit = table.headings[forth.begin()->second].unit;
  for (const auto& [number, column] : forth) {
    const auto other = back.find(number);
    if (other == back.end() || table.headings[column].unit != unit ||
        table.headings[other->second].unit != unit)
      return false;
  }
  return true;
}

/// Columns of each word of the headings.
std::map<std::string, Family> families_of(const sheet::SheetTable& table) {
  std::map<std::string, Family> families;
  for (std::size_t k = 0; k < table.headings.size(); ++k)
    if (const auto parts = parts_of(table.headings[k].name)) families[parts->word].emplace(parts->number, k);
  return families;
}

}  // namespace

void say_directions_of_pairs(sheet::Sheet& sheet, sheet::SheetTable& table) {
  const std::map<std::string, Family> families = families_of(table);
  for (const DirectionPair& pair : kDirectionPairs) {
    const auto forth = families.find(pair.forth), back = families.find(pair.back);
    if (forth == families.end() || back == families.end()) continue;
    if (!same_runs(table, forth->second, back->second)) continue;
    sheet.notes.push_back(fmt::format(
        "\"{}\" and \"{}\" are read as the approach {} of one run, and so on; if this is wrong, write + and "
        "- "
        "behind the numbers of the runs",
        table.headings[forth->second.begin()->second].text, table.headings[back->second.begin()->second].text,
        pair.say_forth == kUp ? "up and down" : "forward and back"));
    for (const auto& [number, column] : forth->second)
      table.headings[column].name = number + " " + pair.say_forth;
    for (const auto& [number, column] : back->second)
      table.headings[column].name = number + " " + pair.say_back;
    return;
  }
}

std::string remedy_for_unknown_runs(const sheet::SheetTable& table) {
  const std::map<std::string, Family> families = families_of(table);
  for (auto a = families.begin(); a != families.end(); ++a)
    for (auto b = std::next(a); b != families.end(); ++b) {
      if (!same_runs(table, a->second, b->second)) continue;
      const std::size_t first = a->second.begin()->second, second = b->second.begin()->second;
      return fmt::format(
          "; if \"{}\", \"{}\" and so on are runs forward and back, write the number and the direction in "
          "their headings: 1+, 1-, 2+ ...",
          table.headings[std::min(first, second)].text, table.headings[std::max(first, second)].text);
    }
  return {};
}

}  // namespace vernier::importer
