// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/tables/golden_listing.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace vernier::golden {
namespace {

constexpr std::size_t kBytesPerLine = 16;

std::string path_of(const std::string& file) {
  return std::string(VERNIER_SOURCE_DIR) + "/tests/golden/" + file;
}

std::string hex(std::uint8_t byte) {
  char text[4];
  std::snprintf(text, sizeof(text), "%02x", byte);
  return text;
}

// One field, from `at` to `end`.
std::string lines_of(const std::vector<std::uint8_t>& bytes, std::size_t at, std::size_t end,
                     const std::string& name) {
  std::string text;
  for (std::size_t start = at; start < end; start += kBytesPerLine) {
    for (std::size_t i = start; i < std::min(end, start + kBytesPerLine); ++i)
      text += (i > start ? " " : "") + hex(bytes[i]);
    text += start == at ? "  # " + name + "\n" : "\n";
  }
  return text;
}

}  // namespace

std::string listed(const std::vector<std::uint8_t>& bytes, const std::vector<Field>& fields) {
  std::string text;
  std::size_t at = 0;
  for (const Field& field : fields) {
    const std::size_t end = std::min(bytes.size(), at + field.bytes);
    text += end == at + field.bytes ? lines_of(bytes, at, end, field.name)
                                    : std::string("= cut off: ") + field.name + "\n";
    at = end;
  }
  return text + lines_of(bytes, at, bytes.size(), "?");
}

std::vector<std::uint8_t> bytes_in(const std::string& listing) {
  std::vector<std::uint8_t> bytes;
  std::istringstream lines(listing);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("=")) continue;
    std::istringstream words(line.substr(0, line.find('#')));
    for (std::string word; words >> word;)
      bytes.push_back(static_cast<std::uint8_t>(std::strtoul(word.c_str(), nullptr, 16)));
  }
  return bytes;
}

std::string golden_text(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(path_of(file)).rdbuf();
  return text.str();
}

void expect_golden(const std::string& file, const std::string& text) {
  if (std::getenv("VERNIER_UPDATE_GOLDEN") != nullptr && !std::filesystem::exists(path_of(file)))
    std::ofstream(path_of(file)) << text;
  EXPECT_EQ(text, golden_text(file))
      << file
      << ": what is stored or sent changed. Another layout is another version: "
         "raise its number, then VERNIER_UPDATE_GOLDEN=1 writes its file";
}

}  // namespace vernier::golden
