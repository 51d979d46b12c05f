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

std::string folder_of(const std::string& path) { return fs::path(path).parent_path().string(); }

/// The first two folders of a path ("tools/fit"), or the one that it has.
std::string room_of(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  fs::path room;
  int depth = 0;
  for (const fs::path& part : folder)
    if (depth++ < 2) room /= part;
  return room.string();
}

/// Which others each one includes.
using Uses = std::map<std::string, std::set<std::string>>;

template <typename Name>
Uses uses_inside_rooms(const std::map<std::string, std::string>& files, Name name) {
  static const std::regex kInclude("#include \"([^\"]+)\"");
  Uses uses;
  for (const auto& [path, text] : files)
    for (std::sregex_iterator it(text.begin(), text.end(), kInclude), end; it != end; ++it) {
      const std::string other = (*it)[1];
      if (room_of(other) == room_of(path) && name(other) != name(path)) uses[name(path)].insert(name(other));
    }
  return uses;
}

void reach(const Uses& uses, const std::string& from, std::set<std::string>& reached) {
  const auto found = uses.find(from);
  if (found == uses.end()) return;
  for (const std::string& next : found->second)
    if (reached.insert(next).second) reach(uses, next, reached);
}

/// Each circle once: its members in order, with blanks between them.
std::vector<std::string> circles(const Uses& uses) {
  std::map<std::string, std::set<std::string>> reached;
  for (const auto& [from, others] : uses) reach(uses, from, reached[from]);
  std::set<std::string> found;
  for (const auto& [from, all] : reached) {
    if (!all.contains(from)) continue;
    std::ostringstream circle;
    for (const std::string& other : all)
      if (const auto back = reached.find(other); back != reached.end() && back->second.contains(from))
        circle << (circle.tellp() > 0 ? " " : "") << other;
    found.insert(circle.str());
  }
  return {found.begin(), found.end()};
}

}  // namespace

std::vector<std::string> circles_of_units(const std::map<std::string, std::string>& files) {
  return circles(uses_inside_rooms(files, unit_of));
}

std::vector<std::string> circles_of_folders(const std::map<std::string, std::string>& files) {
  return circles(uses_inside_rooms(files, folder_of));
}

std::map<std::string, std::size_t> units_in_folders(const std::map<std::string, std::string>& files) {
  std::map<std::string, std::set<std::string>> units;
  for (const auto& [path, text] : files) units[folder_of(path)].insert(unit_of(path));
  std::map<std::string, std::size_t> counts;
  for (const auto& [folder, all] : units) counts[folder] = all.size();
  return counts;
}

}  // namespace vernier::house
