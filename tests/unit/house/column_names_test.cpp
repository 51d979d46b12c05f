// SPDX-License-Identifier: GPL-3.0-or-later
// The measurement format has one owner, tools/format. No other source of tools lists its columns or kinds.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/unit/house/tracked_files.h"

namespace vernier::house {
namespace {

using Names = std::set<std::string>;

/// The names of columns in tools/format/columns.h, with the prefixes of the columns of an axis that are
/// words.
Names names_of_format() {
  const std::string header = text_of("tools/format/columns.h");
  const std::size_t begin = header.find("namespace columns {"), end = header.find("}  // namespace columns");
  Names names;
  const std::regex literal("\"([a-z]+)\"");
  const auto take = [&](const std::string& text) {
    for (std::sregex_iterator one(text.begin(), text.end(), literal), last; one != last; ++one)
      names.insert((*one)[1]);
  };
  if (begin == std::string::npos || end == std::string::npos) return names;
  take(header.substr(begin, end - begin));
  const std::regex prefix("AxisQuantity::k[A-Za-z]+, \"([a-z]{2,})\"");
  for (std::sregex_iterator one(header.begin(), header.end(), prefix), last; one != last; ++one)
    names.insert((*one)[1]);
  return names;
}

/// Names that no other thing in the tools has: wherever such a literal is, it is a column.
const Names& unmistakable() {
  static const Names kNames = {"rx", "ry", "rz",   "ax",    "ay",  "az",    "ix",       "iy",
                               "cx", "cy", "cz",   "px",    "py",  "pz",    "nx",       "ny",
                               "nz", "ua", "curv", "visit", "dir", "since", "corrected"};
  return kNames;
}

struct CodeLiteral {
  std::size_t begin, end;  // of its quotes; end: behind the closing one
  std::string text;
};

std::vector<CodeLiteral> code_literals_of(const std::string& text) {
  static const std::regex kLiteral("\"((?:[^\"\\\\\\n]|\\\\.)*)\"");
  std::vector<CodeLiteral> list;
  for (std::sregex_iterator one(text.begin(), text.end(), kLiteral), last; one != last; ++one)
    list.push_back({static_cast<std::size_t>(one->position()),
                    static_cast<std::size_t>(one->position() + one->length()), (*one)[1]});
  return list;
}

std::string without_comments(const std::string& text) {
  static const std::regex kComment("//[^\\n]*");
  return std::regex_replace(text, kComment, "");
}

std::vector<std::string> words_of_literal(const std::string& text) {
  static const std::regex kWord("[^ ,]+");
  std::vector<std::string> words;
  for (std::sregex_iterator one(text.begin(), text.end(), kWord), last; one != last; ++one)
    words.push_back(one->str());
  return words;
}

std::string front_of(const std::string& text, std::size_t at) {
  const std::size_t last = text.find_last_not_of(" \n", at - 1);
  return last == std::string::npos
             ? ""
             : text.substr(last < 40 ? 0 : last - 40, std::min<std::size_t>(last, 40) + 1);
}

std::string back_of(const std::string& text, std::size_t at) {
  const std::size_t first = text.find_first_not_of(" \n", at);
  return first == std::string::npos ? "" : text.substr(first, 3);
}

/// A key of a JSON object: in brackets, or first in braces before a value that is no literal.
bool is_json_key(const std::string& front, const std::string& back) {
  return (front.ends_with("[") && back.starts_with("]")) ||
         (front.ends_with("{") && back.starts_with(", ") && !back.ends_with("\""));
}

/// Literals of a source by which it knows a column of the measurement file: a name that nothing else has, a
/// name that is compared or looked up, two names in a row, a literal of several names, a heading with its
/// unit.
std::vector<std::string> columns_in_code(const std::string& source, const Names& names) {
  static const std::regex kLookUp(
      "(find|has|need|require|has_recorded|numbers|words|peek|raw|contains|read_column|numeric_column|"
      "column_named|has_word|index_of)\\($");
  static const std::regex kHeading("^([a-z]+)\\[[a-zA-Z/^0-9]+\\](,|$)"),
      kTwoHeadings("(?:^|,)([a-z]+)\\[[a-zA-Z/^0-9]+\\],([a-z]+)(?:\\[|,|$)"),
      kOfEachAxis("^(dir|since|correction)\\{\\}");
  const std::string text = without_comments(source);
  const std::vector<CodeLiteral> list = code_literals_of(text);
  std::vector<std::string> found;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string front = front_of(text, list[i].begin), back = back_of(text, list[i].end);
    const std::vector<std::string> words = words_of_literal(list[i].text);
    std::smatch heading;
    const bool is_heading =
        (std::regex_search(list[i].text, heading, kHeading) && names.contains(heading[1])) ||
        (std::regex_search(list[i].text, heading, kTwoHeadings) && names.contains(heading[1]) &&
         names.contains(heading[2])) ||
        std::regex_search(list[i].text, kOfEachAxis);
    const bool several = words.size() > 1 && std::all_of(words.begin(), words.end(), [&](const auto& word) {
                           return names.contains(word);
                         });
    bool known = is_heading || several;
    if (names.contains(list[i].text) && !is_json_key(front, back)) {
      const bool compared =
          front.ends_with("==") || front.ends_with("!=") || back.starts_with("==") || back.starts_with("!=");
      const auto in_a_row = [&](std::size_t a, std::size_t b) {
        return b < list.size() && names.contains(list[a].text) && names.contains(list[b].text) &&
               words_of_literal(text.substr(list[a].end, list[b].begin - list[a].end)).empty();
      };
      const bool next = in_a_row(i, i + 1) || (i > 0 && in_a_row(i - 1, i));
      known = known || compared || next || unmistakable().contains(list[i].text) ||
              std::regex_search(front, kLookUp);
    }
    if (known) found.push_back(list[i].text);
  }
  return found;
}

TEST(ColumnNames, OfTheFormatAreFound) {
  const Names names = names_of_format();
  for (const char* name : {"x", "rz", "length", "d", "az", "distance", "iy", "setup", "role", "dir", "since"})
    EXPECT_TRUE(names.contains(name)) << name;
  EXPECT_GE(names.size(), 36u) << "the header was not read";
  for (const std::string& name : unmistakable()) EXPECT_TRUE(names.contains(name)) << name;
}

TEST(ColumnNames, AreDetectedInCode) {
  const Names names = names_of_format();
  EXPECT_EQ(columns_in_code("for (const char* name : {\"x\", \"y\", \"z\"}) f(name);", names).size(), 3u);
  EXPECT_EQ(columns_in_code("static const Words kNames = {\"x\", \"rx\"};", names).size(), 2u);
  EXPECT_EQ(columns_in_code("KnownColumn{\"rx\", \"deg\"},", names).size(), 1u);
  EXPECT_EQ(columns_in_code("if (column.name == \"t\") f();", names).size(), 1u);
  EXPECT_EQ(columns_in_code("if (\"setup\" != name) f();", names).size(), 1u);
  EXPECT_EQ(columns_in_code("table.find(\"distance\")", names).size(), 1u);
  EXPECT_EQ(columns_in_code("motion(\"dir\" + axis.name);", names).size(), 1u);
  EXPECT_EQ(columns_in_code("return \"x[mm],y[mm],z[mm]\";", names).size(), 1u);
  EXPECT_EQ(columns_in_code("text + \",bounces,u[um],level\\n\";", names).size(), 0u) << "one heading alone";
  EXPECT_EQ(columns_in_code("text + \",x[mm],y[mm],z[mm]\\n\";", names).size(), 1u);
  EXPECT_EQ(columns_in_code("fmt::format(\"dir{}\", axis)", names).size(), 1u);
  EXPECT_EQ(columns_in_code("has_all(table, \"nx ny nz\")", names).size(), 1u);
}

TEST(ColumnNames, OtherUsesOfTheWordsPass) {
  const Names names = names_of_format();
  EXPECT_TRUE(columns_in_code("json[\"length\"] = 3;  // \"x\", \"y\"", names).empty());
  EXPECT_TRUE(columns_in_code("{{\"run\", m.run}, {\"since\", one.since + 1}}", names).empty());
  EXPECT_TRUE(columns_in_code("throw InputError(\"no row has x and y\");", names).empty());
  EXPECT_TRUE(columns_in_code("attribute(node, \"setup\")", names).empty());
  EXPECT_TRUE(columns_in_code("add_option(\"length\", value)", names).empty());
}

TEST(ColumnNames, StandInToolsFormatAlone) {
  // The same words with another meaning.
  const std::map<std::string, Names> allowed = {
      {"tools/create/dh_table.cpp", {"d"}},                               // a Denavit-Hartenberg parameter
      {"tools/create/urdf.cpp", {"d"}},                                   // the same, in names of statics
      {"tools/effects/candidate.cpp", {"from"}},                          // a placeholder of an effect's term
      {"tools/tolerance/machine_sources.cpp", {"from"}},                  // the same
      {"tools/import/words/doubtful_words.cpp", {"x"}},                   // "2 x": times
      {"tools/import/words/stated_directions.cpp", {"from"}},             // "from below"
      {"tools/lint/machine_lint.cpp", {"run"}},                           // an attribute of the machine file
      {"tools/model/machine_reader.cpp", {"u", "from", "run", "setup"}},  // attributes of the machine file
      {"tools/sheet/workbook.cpp", {"t"}}};                               // an element of a workbook's XML
  const Names names = names_of_format();
  ASSERT_FALSE(names.empty());
  const auto files = tracked_files();
  if (files.empty()) GTEST_SKIP() << "not a git checkout: no list of tracked files";
  std::size_t seen = 0;
  std::map<std::string, Names> used;
  for (const std::string& file : files) {
    if (!file.starts_with("tools/") || file.starts_with("tools/format/")) continue;
    if (!file.ends_with(".cpp") && !file.ends_with(".h")) continue;
    ++seen;
    for (const std::string& word : columns_in_code(text_of(file), names)) {
      const auto excused = allowed.find(file);
      if (excused != allowed.end() && excused->second.contains(word))
        used[file].insert(word);
      else
        ADD_FAILURE() << file << ": \"" << word << "\" is a column of the measurement file: take it from "
                      << "tools/format/columns.h";
    }
  }
  EXPECT_GT(seen, 400u) << "the walk over the sources found next to nothing";
  EXPECT_EQ(used, allowed) << "an exemption that nothing needs";
}

}  // namespace
}  // namespace vernier::house
