// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/house/tracked_files.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

namespace vernier::house {

std::vector<std::string> tracked_files() {
  const std::string command = std::string("git -C '") + VERNIER_SOURCE_DIR + "' ls-files -z 2>/dev/null";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::vector<std::string> files;
  std::string name;
  for (int c = pipe ? std::fgetc(pipe.get()) : EOF; c != EOF; c = std::fgetc(pipe.get())) {
    if (c != '\0') {
      name.push_back(static_cast<char>(c));
      continue;
    }
    if (std::filesystem::is_regular_file(std::filesystem::path(VERNIER_SOURCE_DIR) / name))
      files.push_back(name);
    name.clear();
  }
  return files;
}

std::string text_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(std::filesystem::path(VERNIER_SOURCE_DIR) / path, std::ios::binary).rdbuf();
  return text.str();
}

}  // namespace vernier::house
