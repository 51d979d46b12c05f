// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/offline/program_words.h"

#include <algorithm>
#include <cctype>

#include "tools/text/error.h"
#include "tools/text/numbers.h"

namespace vernier::offline {

std::vector<Word> words_of(const std::string& line, const text::Place& place) {
  std::vector<Word> words;
  for (std::size_t i = 0; i < line.size();) {
    const char c = line[i];
    if (std::isspace(static_cast<unsigned char>(c)) != 0) {
      ++i;
    } else if (c == ';' || c == '(') {
      const auto end = c == ';' ? line.size() : line.find(')', i);
      if (end == std::string::npos)
        throw text::InputError(place, line.substr(i, 20), "the comment has no closing parenthesis");
      const std::size_t next = std::min(end + 1, line.size());
      words.push_back({'(', 0, line.substr(i, next - i)});
      i = next;
    } else if (c == '%' || c == '/') {
      words.push_back({c, 0, std::string(1, c)});
      ++i;
    } else {
      const std::size_t from = i++;
      while (i < line.size() && std::isspace(static_cast<unsigned char>(line[i])) != 0) ++i;
      const std::size_t number = i;
      while (i < line.size() && (std::isdigit(static_cast<unsigned char>(line[i])) != 0 || line[i] == '.' ||
                                 line[i] == '-' || line[i] == '+'))
        ++i;
      const char letter = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
      const auto value = text::parse_number(line.substr(number, i - number));
      if (std::isalpha(static_cast<unsigned char>(c)) == 0 || !value)
        throw text::InputError(
            place, line.substr(from, std::max<std::size_t>(i - from, 8)),
            "parameters, expressions and loops are not supported: write the blocks out with numbers first");
      words.push_back({letter, *value, line.substr(from, i - from)});
    }
  }
  return words;
}

std::optional<double> value_of(const std::vector<Word>& words, char letter) {
  const auto found =
      std::find_if(words.begin(), words.end(), [&](const Word& word) { return word.letter == letter; });
  return found == words.end() ? std::nullopt : std::optional(found->value);
}

}  // namespace vernier::offline
