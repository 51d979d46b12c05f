// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/import/ballbar/ballbar_file.h"

namespace vernier {

inline std::string ballbar_data(const std::string& name) {
  return std::string(VERNIER_SOURCE_DIR) + "/tests/data/ballbar/" + name;
}

inline std::string text_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// A file with this text in the tests' own folder; the folder is named for the process, so tests may run side
/// by side.
class ScratchFile {
 public:
  ScratchFile(const std::string& name, const std::string& text) {
    static int count = 0;
    path_ = (std::filesystem::path(::testing::TempDir()) /
             (std::to_string(::getpid()) + "-" + std::to_string(count++) + "-" + name))
                .string();
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~ScratchFile() { std::filesystem::remove(path_); }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// `text` with its first `from` replaced by `to`.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("nothing to replace: " + from);
  return text.replace(at, from.size(), to);
}

/// Cells of a comma-separated line.
inline std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> found;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) found.push_back(cell);
  return found;
}

/// The file's printed result `feature` of an analysis of that version ("": no version); nullopt: no such
/// result.
inline std::optional<double> printed_result(const importer::BallbarFile& file, const std::string& analysis,
                                            const std::string& version, const std::string& feature) {
  for (const auto& candidate : file.analyses)
    if (candidate.name == analysis && candidate.version == version)
      for (const auto& printed : candidate.features)
        if (printed.name == feature) return printed.value;
  return std::nullopt;
}

}  // namespace vernier
