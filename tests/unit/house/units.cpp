// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/house/units.h"

#include <filesystem>
#include <regex>
#include <set>
#include <sstream>

namespace vernier::house {
namespace {

namespace fs = std::filesystem;

/// The unit of a file or of an include: its path without extension.
std::string unit_of(const std::string& path) { return fs::path(path).replace_extension().string(); }

using Uses = std::map<std::string, std::set<std::string>>;

void reach(const Uses& uses, const std::string& from, std::set<std::string>& reached) {
  const auto found = uses.find(from);
  if (found == uses.end()) return;
  for (const std::string& next : found->second)
    if (reached.insert(next).second) reach(uses, next, reached);
}

}  // namespace

std::vector<std::string> circles_of_units(const std::map<std::string, std::string>& files) {
  static const std::regex kInclude("#include \"([^\"]+)\"");
  Uses uses;
  for (const auto& [path, text] : files)
    for (std::sregex_iterator it(text.begin(), text.end(), kInclude), end; it != end; ++it) {
      const std::string other = (*it)[1];
      if (fs::path(other).parent_path() == fs::path(path).parent_path() && unit_of(other) != unit_of(path))
        uses[unit_of(path)].insert(unit_of(other));
    }
  std::map<std::string, std::set<std::string>> reached;
  for (const auto& [unit, others] : uses) reach(uses, unit, reached[unit]);
  std::set<std::string> circles;
  for (const auto& [unit, all] : reached) {
    if (!all.contains(unit)) continue;
    std::ostringstream circle;
    circle << fs::path(unit).parent_path().string() << ":";
    for (const std::string& other : all)
      if (const auto back = reached.find(other); back != reached.end() && back->second.contains(unit))
        circle << ' ' << fs::path(other).filename().string();
    circles.insert(circle.str());
  }
  return {circles.begin(), circles.end()};
}

}  // namespace vernier::house
