// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/lint/finding.h"

namespace vernier::lint {

/// Kind of a file by its contents.
enum class LintedKind { kMachine, kMeasurement, kSpreadsheet, kOther };
LintedKind linted_kind_of(const std::string& bytes, const std::string& file);
/// "machine", "measurement", "spreadsheet", "other".
const char* linted_kind_name(LintedKind kind);

struct LintedFile {
  std::string file;
  LintedKind kind = LintedKind::kOther;
  bool usable = false;
  std::vector<LintFinding> findings;
};

/// Tests machine and measurement files in any order: first the machines, then each measurement against the
/// first machine that could be read. Throws InputError for a file that cannot be opened.
std::vector<LintedFile> lint_files(const std::vector<std::string>& paths);

}  // namespace vernier::lint
