// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

namespace vernier::house {
namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::set<std::string> ids_of_catalogue(const std::string& catalogue) {
  std::set<std::string> ids;
  std::istringstream lines(catalogue);
  for (std::string line; std::getline(lines, line);)
    if (line.rfind("effect ", 0) == 0) ids.insert(line.substr(7));
  return ids;
}

bool in_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-'; }

/// Is what stands in front of, or behind, a place in the text a comparison?
bool is_compared(const std::string& text, std::size_t begin, std::size_t end) {
  const auto before = text.find_last_not_of(" \n", begin - 1), after = text.find_first_not_of(" \n", end);
  const auto is_equality = [&](std::size_t at) {
    return text.compare(at, 2, "==") == 0 || text.compare(at, 2, "!=") == 0;
  };
  return (before != std::string::npos && before > 0 && is_equality(before - 1)) ||
         (after != std::string::npos && is_equality(after));
}

/// Ids that stand in string literals of a source: one of several words (servo-lag) anywhere in it, one that
/// is a word of the language as well (offset) where something is compared with it.
std::vector<std::string> ids_in_code(const std::string& text, const std::set<std::string>& ids) {
  std::vector<std::string> found;
  for (const std::string& id : ids)
    for (std::size_t at = text.find(id); at != std::string::npos; at = text.find(id, at + 1)) {
      const std::size_t end = at + id.size(), line = text.rfind('\n', at) + 1;
      if (at == 0 || end >= text.size() || in_word(text[at - 1]) || in_word(text[end])) continue;
      const std::string front = text.substr(line, at - line);
      if (std::count(front.begin(), front.end(), '"') % 2 == 0) continue;  // a remark, or code
      const bool whole = text[at - 1] == '"' && text[end] == '"';
      if (id.find('-') != std::string::npos || (whole && is_compared(text, at - 1, end + 1)))
        found.push_back(id);
    }
  return found;
}

TEST(EffectIds, AreFoundInLiteralsAndInComparisonsOnly) {
  const std::set<std::string> ids = {"servo-lag", "offset"};
  EXPECT_EQ(ids_in_code("if (effect.id == \"servo-lag\") x();", ids).size(), 1u);
  EXPECT_EQ(ids_in_code("f(\"servo-lag of X\");", ids).size(), 1u);
  EXPECT_EQ(ids_in_code("if (effect.id ==\n    \"offset\") x();", ids).size(), 1u);
  EXPECT_EQ(ids_in_code("if (\"offset\" != id) x();", ids).size(), 1u);
  EXPECT_EQ(ids_in_code("json[\"offset\"] = 3;  // as servo-lag\n", ids).size(), 0u);
  EXPECT_EQ(ids_in_code("f(\"--no-servo-lag\");", ids).size(), 0u);
}

// What code needs to know of an effect is a property in the catalogue, so that an effect of a user's own can
// have it.
TEST(EffectIds, StandInTheCatalogueAndNotInTheCode) {
  const fs::path tools = fs::path(VERNIER_SOURCE_DIR) / "tools";
  const std::set<std::string> ids = ids_of_catalogue(content_of(tools / "effects/catalogue.txt"));
  ASSERT_GT(ids.size(), 20u) << "the catalogue was not read";
  std::size_t files = 0;
  for (auto it = fs::recursive_directory_iterator(tools); it != fs::recursive_directory_iterator(); ++it) {
    if (it->path().filename() == "node_modules") it.disable_recursion_pending();
    const auto extension = it->path().extension();
    if (!it->is_regular_file() || (extension != ".h" && extension != ".cpp" && extension != ".js")) continue;
    ++files;
    for (const std::string& id : ids_in_code(content_of(it->path()), ids))
      ADD_FAILURE() << fs::relative(it->path(), tools).string() << ": the effect \"" << id << "\" in code";
  }
  EXPECT_GT(files, 200u) << "the walk over the sources found next to nothing";
}

}  // namespace
}  // namespace vernier::house
