// SPDX-License-Identifier: GPL-3.0-or-later
// What is written for users uses the field's terms: a list of phrases that it does not use.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string>
#include <vector>

#include "tests/unit/house/tracked_files.h"

namespace vernier::house {
namespace {

struct Phrase {
  std::string text, instead;
};

std::vector<Phrase> phrases() {
  std::vector<Phrase> list;
  std::istringstream lines(text_of("tests/unit/house/plain_words.txt"));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t bar = line.find(" | ");
    if (!line.starts_with("#") && bar != std::string::npos)
      list.push_back({line.substr(0, bar), line.substr(bar + 3)});
  }
  return list;
}

/// Small letters; what parts two words (blanks, a line's end with the marks of its comment or literal) is one
/// blank.
std::string flowing(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool gap = std::isspace(static_cast<unsigned char>(c)) != 0 || c == '/' || c == '"' || c == '#';
    if (!gap)
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (!result.empty() && result.back() != ' ')
      result += ' ';
  }
  return result;
}

bool is_letter(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// text: flowing.
bool has_phrase(const std::string& text, const std::string& phrase) {
  for (std::size_t at = text.find(phrase); at != std::string::npos; at = text.find(phrase, at + 1)) {
    const std::size_t end = at + phrase.size();
    if ((at == 0 || !is_letter(text[at - 1])) && (end == text.size() || !is_letter(text[end]))) return true;
  }
  return false;
}

/// Pages, programs and what they print. Tests, data and what is kept of released versions may say what they
/// like.
bool is_written_for_users(const std::string& path) {
  if (path.starts_with("tests/") || path == "CHANGELOG.md") return false;
  const std::vector<std::string> endings = {".md", ".h", ".cpp", ".js", ".txt", ".html", ".in"};
  return std::any_of(endings.begin(), endings.end(),
                     [&](const std::string& ending) { return path.ends_with(ending); });
}

TEST(PlainWords, APhraseIsFoundAcrossLines) {
  EXPECT_TRUE(has_phrase(flowing("/// Errors hang\n/// together in time.\n"), "hang together"));
  EXPECT_TRUE(has_phrase(flowing("\"The rows Hang \"\n    \"together.\""), "hang together"));
  EXPECT_FALSE(has_phrase(flowing("what is toldfrom"), "told from"));
  EXPECT_FALSE(has_phrase(flowing("correlated errors"), "hang together"));
}

TEST(PlainWords, AreUsed) {
  const std::vector<std::string> files = tracked_files();
  if (files.empty()) GTEST_SKIP() << "not a git checkout: no list of tracked files";
  const std::vector<Phrase> list = phrases();
  ASSERT_GT(list.size(), 20u);
  std::size_t seen = 0;
  for (const std::string& file : files) {
    if (!is_written_for_users(file)) continue;
    ++seen;
    const std::string text = flowing(text_of(file));
    for (const Phrase& phrase : list)
      EXPECT_FALSE(has_phrase(text, phrase.text))
          << file << ": \"" << phrase.text << "\": write " << phrase.instead;
  }
  EXPECT_GT(seen, 500u) << "the walk over the files found next to nothing";
}

}  // namespace
}  // namespace vernier::house
