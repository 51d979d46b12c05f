// SPDX-License-Identifier: GPL-3.0-or-later
// tools/docs/assurances.md lists every word by which a user is told that something is valid, safe or kept.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/unit/house/named_tests.h"
#include "tests/unit/house/tracked_files.h"

namespace vernier::house {
namespace {

const char* const kPage = "tools/docs/assurances.md";

/// Words that assure; a text with one of them is looked for on the page.
const std::regex& assuring() {
  static const std::regex kWords(
      R"(\b(valid|safe|kept|conforms|consistent|complete|met|ok|accepted|confirmed|online|proved|settled|all there|nothing odd|nothing to add|no evidence|in effect|up to date|healthy|passes|passed)\b)",
      std::regex::icase);
  return kWords;
}

/// Texts of a source: adjacent literals as one, without comments.
std::vector<std::string> literals_of(const std::string& source) {
  std::vector<std::string> list;
  std::string text;
  bool open = false;
  for (std::size_t i = 0; i < source.size(); ++i) {
    if (source.compare(i, 2, "//") == 0) {
      i = source.find('\n', i);
      if (i == std::string::npos) break;
    } else if (source[i] == '\'' && i + 2 < source.size()) {
      const std::size_t end = source.find('\'', i + (source[i + 1] == '\\' ? 3 : 2));
      if (end != std::string::npos && end - i <= 4) i = end;
    } else if (source[i] == '"') {
      for (++i; i < source.size() && source[i] != '"'; ++i) {
        text += source[i];
        if (source[i] == '\\' && i + 1 < source.size()) text += source[++i];
      }
      open = true;
    } else if (open && std::isspace(static_cast<unsigned char>(source[i])) == 0) {
      list.push_back(text);
      text.clear();
      open = false;
    }
  }
  if (open) list.push_back(text);
  return list;
}

/// As the page writes it: fields as {}, no line ends, one blank between words, no quotes' backslashes.
std::string plain(std::string text) {
  text = std::regex_replace(text, std::regex(R"(\\n)"), " ");
  text = std::regex_replace(text, std::regex(R"(\\")"), "\"");
  text = std::regex_replace(text, std::regex(R"(\{[^{}]*\})"), "{}");
  text = std::regex_replace(text, std::regex(R"(\s+)"), " ");
  const auto begin = text.find_first_not_of(' '), end = text.find_last_not_of(' ');
  return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

bool speaks(const std::string& file) {
  if (!file.ends_with(".cpp")) return false;
  constexpr std::array kFolders = {
      "tools/check/",    "tools/commands/", "tools/diagnose/", "tools/evaluate/", "tools/fleet/",
      "tools/lint/",     "tools/map/",      "tools/offline/",  "tools/part/",     "tools/plan/",
      "tools/registry/", "tools/results/",  "tools/safety/",   "tools/simulate/", "tools/tolerance/",
      "tools/upload/",   "tools/exchange/", "firmware/daemon/"};
  return std::any_of(kFolders.begin(), kFolders.end(),
                     [&](const char* folder) { return file.starts_with(folder); });
}

/// What stands in backquotes on the page.
std::set<std::string> quoted(const std::string& page) {
  std::set<std::string> all;
  const std::regex quote("`([^`\n]+)`");
  for (auto at = std::sregex_iterator(page.begin(), page.end(), quote); at != std::sregex_iterator(); ++at)
    all.insert(plain((*at)[1]));
  return all;
}

TEST(Assurances, AWordThatIsNotOnThePageIsDetected) {
  const auto texts = literals_of("f(\"the machine is \" \"safe\"); // \"valid\"\ng('\"', \"{:.3g} um\\n\");");
  ASSERT_EQ(texts.size(), 2U);
  EXPECT_EQ(texts[0], "the machine is safe");
  EXPECT_EQ(plain(texts[1]), "{} um");
  EXPECT_TRUE(std::regex_search(texts[0], assuring()));
  EXPECT_FALSE(std::regex_search(std::string("validation"), assuring()));
  EXPECT_EQ(quoted("| `kept` | x |").count("kept"), 1U);
}

TEST(Assurances, EveryAssuringTextIsOnThePage) {
  const auto files = tracked_files();
  if (files.empty()) GTEST_SKIP() << "not a git checkout: no list of tracked files";
  const std::set<std::string> page = quoted(text_of(kPage));
  std::set<std::string> seen;
  for (const std::string& file : files) {
    if (!speaks(file)) continue;
    for (const std::string& literal : literals_of(text_of(file))) {
      // Help texts and statements of a database are longer than any verdict.
      constexpr std::size_t kLongest = 120;
      if (!std::regex_search(literal, assuring()) || literal.ends_with(".h")) continue;
      if (plain(literal).size() > kLongest) continue;
      seen.insert(plain(literal));
      EXPECT_TRUE(page.contains(plain(literal))) << file << ": `" << plain(literal) << "` is not on " << kPage
                                                 << ": list when it is said, what it does not cover and the "
                                                    "test in which the truth is no, or that it "
                                                    "assures nothing";
    }
  }
  EXPECT_GT(seen.size(), 40U) << "the walk over the sources found next to nothing";
}

TEST(Assurances, EveryTestThatThePageNamesIsThere) {
  if (tracked_files().empty()) GTEST_SKIP() << "not a git checkout: no list of tracked files";
  const std::set<std::string> named = named_tests(text_of(kPage));
  for (const std::string& name : tests_that_are_missing(named))
    ADD_FAILURE() << kPage << " names the test " << name << ", which is not there";
  EXPECT_GT(named.size(), 15U);
}

}  // namespace
}  // namespace vernier::house
