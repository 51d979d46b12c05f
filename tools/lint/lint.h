// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/lint/finding.h"

namespace vernier::lint {

/// Kind of a file, which is determined from its content.
enum class LintedKind { kMachine, kMeasurement, kSpreadsheet, kOther };
LintedKind linted_kind_of(const std::string& bytes, const std::string& file);
/// Returns the name of a kind of file: "machine", "measurement", "spreadsheet", "other".
const char* linted_kind_name(LintedKind kind);

struct LintedFile {
  std::string file;
  LintedKind kind = LintedKind::kOther;
  bool usable = false;
  std::vector<LintFinding> findings;
};

/// Tests machine files and measurement files, given in any order. Of the given files, the machine files are
/// tested before the measurement files. Each measurement file is then tested with the first machine that
/// could be read. Throws InputError if a file cannot be opened.
std::vector<LintedFile> lint_files(const std::vector<std::string>& paths);
/// The same for files that were read already. `names`: the names for the findings; `bytes`: the contents.
std::vector<LintedFile> lint_contents(const std::vector<std::string>& names,
                                      const std::vector<std::string>& bytes);

}  // namespace vernier::lint
