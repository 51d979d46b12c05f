// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/house/named_tests.h"

#include <regex>

#include "tests/unit/house/tracked_files.h"

namespace vernier::house {

std::set<std::string> named_tests(const std::string& page) {
  std::set<std::string> named;
  const std::regex name(R"(`([A-Z]\w+\.[A-Z]\w+)`)");
  for (auto at = std::sregex_iterator(page.begin(), page.end(), name); at != std::sregex_iterator(); ++at)
    named.insert((*at)[1]);
  return named;
}

std::set<std::string> tests_that_are_missing(const std::set<std::string>& named) {
  std::set<std::string> written;
  const std::regex head(R"(TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\s*\)|NAME (\w+)\.(\w+))");
  for (const std::string& file : tracked_files()) {
    if (!file.starts_with("tests/") || !(file.ends_with("_test.cpp") || file.ends_with("CMakeLists.txt")))
      continue;
    const std::string text = text_of(file);
    for (auto at = std::sregex_iterator(text.begin(), text.end(), head); at != std::sregex_iterator(); ++at)
      written.insert((*at)[1].matched ? (*at)[1].str() + "." + (*at)[2].str()
                                      : (*at)[3].str() + "." + (*at)[4].str());
  }
  std::set<std::string> missing;
  for (const std::string& one : named)
    if (!written.contains(one)) missing.insert(one);
  return missing;
}

}  // namespace vernier::house
