// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/format/row_counts.h"

#include <algorithm>
#include <set>
#include <vector>

#include "tools/text/words.h"

namespace vernier::format {

bool names_row_count(const std::string& name, const std::string& unit) {
  static const std::set<std::string> kWords = {"nr",    "no",    "num", "nummer", "number", "lfd",  "row",
                                               "zeile", "index", "idx", "line",   "point",  "punkt"};
  if (!unit.empty()) return false;
  if (name == "column_") return true;
  const std::vector<std::string> words = text::words_in(text::in_small_letters(name), "_.");
  return !words.empty() && std::all_of(words.begin(), words.end(),
                                       [](const std::string& word) { return kWords.contains(word); });
}

}  // namespace vernier::format
