// SPDX-License-Identifier: GPL-3.0-or-later
// The page of the sources says what reproduces each of their statements: its commands are run, its figures
// looked for in what they print, its tests looked for among the tests, its rows counted.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include "tools/text/files.h"
#include "tools/text/words.h"

namespace vernier::sources_test {

using namespace vernier::text;
namespace {

namespace fs = std::filesystem;

constexpr const char* kStates[] = {"works", "partly", "not applicable"};

struct Row {
  std::size_t line = 0;
  std::string place, by, figure, state;
};

/// Cells of a row of a table; "\|" is a bar of the text.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (line[i] == '\\' && i + 1 < line.size() && line[i + 1] == '|')
      cells.back() += line[++i];
    else if (line[i] == '|')
      cells.emplace_back();
    else
      cells.back() += line[i];
  }
  cells.pop_back();
  for (std::string& cell : cells) cell = trimmed(cell);
  return cells;
}

std::vector<std::string> quoted(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t at = text.find('`'); at != std::string::npos;) {
    const std::size_t end = text.find('`', at + 1);
    if (end == std::string::npos) break;
    words.push_back(text.substr(at + 1, end - at - 1));
    at = text.find('`', end + 1);
  }
  return words;
}

const std::string& page() {
  static const std::string kPage = read_file(VERNIER_SOURCE_DIR "/tools/docs/sources.md");
  return kPage;
}

std::vector<Row> rows() {
  std::vector<Row> list;
  std::istringstream in(page());
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (!line.starts_with("| ") || line.starts_with("| place |")) continue;
    const std::vector<std::string> cells = cells_of(line);
    EXPECT_EQ(cells.size(), 5u) << "line " << number;
    if (cells.size() == 5) list.push_back({number, cells[0], cells[2], cells[3], cells[4]});
  }
  return list;
}

bool is_command(const std::string& words) {
  return words.starts_with("vernier ") || words.starts_with("printf ");
}

/// Every `Suite.Case` that the repository has.
std::set<std::string> tests_of_the_repository() {
  std::set<std::string> names;
  for (const auto& file : fs::recursive_directory_iterator(VERNIER_SOURCE_DIR "/tests")) {
    if (file.path().extension() != ".cpp") continue;
    const std::string text = read_file(file.path().string());
    for (std::size_t at = text.find("\nTEST"); at != std::string::npos; at = text.find("\nTEST", at + 1)) {
      const std::size_t open = text.find('(', at), comma = text.find(',', at), close = text.find(')', at);
      if (open < comma && comma < close)
        names.insert(trimmed(text.substr(open + 1, comma - open - 1)) + "." +
                     trimmed(text.substr(comma + 1, close - comma - 1)));
    }
  }
  return names;
}

TEST(SourcesPage, EveryRowSaysWhatReproducesItOrWhyNothingDoes) {
  const std::set<std::string> tests = tests_of_the_repository();
  for (const Row& row : rows()) {
    const std::string where = "tools/docs/sources.md:" + std::to_string(row.line) + " " + row.place;
    EXPECT_NE(std::find(std::begin(kStates), std::end(kStates), row.state), std::end(kStates)) << where;
    if (row.state == "works") {
      EXPECT_FALSE(row.by.empty()) << where;
    } else {
      EXPECT_FALSE(row.figure.empty()) << where << ": why?";
    }
    for (const std::string& word : quoted(row.by)) {
      if (is_command(word)) continue;
      EXPECT_TRUE(tests.contains(word)) << where << ": no test " << word;
    }
  }
}

TEST(SourcesPage, RowsAreCounted) {
  std::map<std::string, std::size_t> count;
  for (const Row& row : rows()) ++count[row.state];
  const std::string words = std::to_string(rows().size()) + " statements: " + std::to_string(count["works"]) +
                            " work, " + std::to_string(count["partly"]) + " partly, " +
                            std::to_string(count["not applicable"]) + " not applicable.";
  EXPECT_NE(page().find(words), std::string::npos) << words;
}

TEST(SourcesPage, CommandsPrintTheFiguresOfThePage) {
  // GIVEN a folder that looks like the root of a checkout
  const std::string folder = testing::TempDir() + "sources_" + std::to_string(getpid());
  fs::create_directories(folder);
  for (const char* name : {"tables", "tests", "tools"})
    fs::create_directory_symlink(std::string(VERNIER_SOURCE_DIR) + "/" + name, folder + "/" + name);
  std::map<std::string, std::string> said;
  std::string command;
  std::size_t commands = 0, figures = 0;
  for (const Row& row : rows()) {
    const std::vector<std::string> by = quoted(row.by);
    if (row.by != "the same") command = !by.empty() && is_command(by.front()) ? by.front() : "";
    if (command.empty()) continue;
    // WHEN each command is run once
    if (!said.contains(command)) {
      write_file(folder + "/script", command + "\n");
      const int status = std::system(
          ("cd '" + folder + "' && PATH=" VERNIER_BIN_DIR ":$PATH timeout 300 bash -e script >out.txt 2>&1")
              .c_str());
      said[command] = read_file(folder + "/out.txt");
      EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 0) << command << "\n" << said[command];
      ++commands;
    }
    // THEN it prints what the page says
    for (const std::string& figure : quoted(row.figure)) {
      EXPECT_NE(said[command].find(figure), std::string::npos)
          << "tools/docs/sources.md:" << row.line << ": " << figure << " is not what is printed by\n"
          << command << "\n"
          << said[command];
      ++figures;
    }
  }
  fs::remove_all(folder);
  EXPECT_GE(commands, 15u);
  EXPECT_GE(figures, 20u);
}

}  // namespace
}  // namespace vernier::sources_test
