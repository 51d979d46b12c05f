// SPDX-License-Identifier: GPL-3.0-or-later
// firmware/docs/hazards.md has each fault of the firmware, and its tests exist.
#include <gtest/gtest.h>

#include <cctype>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/unit/house/named_tests.h"
#include "tests/unit/house/tracked_files.h"

namespace vernier::house {
namespace {

const char* const kHazards = "firmware/docs/hazards.md";

/// Number and name of each fault, from the enumeration: kPositionMissing is position-missing.
std::map<int, std::string> faults_of(const std::string& codes) {
  std::map<int, std::string> faults;
  std::smatch list;
  if (!std::regex_search(codes, list, std::regex(R"(enum class Fault [^{]*\{([^}]*)\})"))) return faults;
  const std::string entries = list[1];
  const std::regex entry(R"(\bk(\w+) = (\d+))");
  for (auto at = std::sregex_iterator(entries.begin(), entries.end(), entry); at != std::sregex_iterator();
       ++at) {
    std::string name;
    for (const char letter : (*at)[1].str()) {
      const auto small = std::tolower(static_cast<unsigned char>(letter));
      if (small != letter && !name.empty()) name += '-';
      name += static_cast<char>(small);
    }
    faults[std::stoi((*at)[2])] = name;
  }
  faults.erase(0);  // no fault
  return faults;
}

/// Rows of the page's tables, without the headings.
std::vector<std::string> table_rows(const std::string& page) {
  std::vector<std::string> rows;
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("| ") && line.find("failure | effect") == std::string::npos) rows.push_back(line);
  return rows;
}

/// True if the last cell of a row names a test, or begins a reason with "untested: ".
bool says_its_test(const std::string& row) {
  const std::string cell = row.substr(row.rfind('|', row.size() - 2));
  return !named_tests(cell).empty() || cell.find("untested: ") != std::string::npos;
}

TEST(Hazards, AFaultWithoutARowIsDetected) {
  const auto faults = faults_of("enum class Fault : int {\n  kNone = 0,\n  kInputMissing = 4,  // x\n};");
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults.at(4), "input-missing");
  EXPECT_TRUE(says_its_test("| a | `Some.Test` |"));
  EXPECT_FALSE(says_its_test("| `Some.Test` | none |"));
  EXPECT_FALSE(tests_that_are_missing({"Hazards.ThatNobodyWrote"}).empty());
}

TEST(Hazards, EachFaultOfTheFirmwareHasItsRow) {
  const std::string page = text_of(kHazards);
  const auto faults = faults_of(text_of("tables/codes.h"));
  EXPECT_GE(faults.size(), 10U);
  for (const auto& [number, name] : faults)
    EXPECT_NE(page.find("\n| `" + name + "` (" + std::to_string(number) + ") | "), std::string::npos)
        << kHazards << " has no row for the fault " << name << " (" << number << ")";
}

TEST(Hazards, EachRowNamesATestThatExistsOrSaysThatThereIsNone) {
  if (tracked_files().empty()) GTEST_SKIP() << "not a git checkout: no list of tracked files";
  const std::string page = text_of(kHazards);
  const auto rows = table_rows(page);
  EXPECT_GE(rows.size(), 25U);
  for (const std::string& row : rows) EXPECT_TRUE(says_its_test(row)) << row;
  for (const std::string& name : tests_that_are_missing(named_tests(page)))
    ADD_FAILURE() << kHazards << " names the test " << name << ", which is not there";
}

}  // namespace
}  // namespace vernier::house
