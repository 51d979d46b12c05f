// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace vernier::lint {

/// Severity of a lint finding.
enum class LintWeight {
  kError,    // the file cannot be used
  kWarning,  // the file can be used, but its meaning probably differs from the intention
  kRemark,   // information for the user
};

/// Returns the name of a severity: "error", "warning", "remark".
const char* weight_name(LintWeight weight);

/// One error or doubtful entry that lint found in a file.
struct LintFinding {
  std::string file;
  std::size_t line = 0;  // line number; 0: the finding is about the whole file
  LintWeight weight = LintWeight::kError;
  std::string word;     // the wrong word; may be empty
  std::string what;     // description of the problem
  std::string meaning;  // probable meaning, and what the user can do; may be empty
};

/// Returns a finding as one line of text: "file:12: error: "word": what (meaning)".
std::string in_one_line(const LintFinding& finding);
/// Returns a finding as JSON: {file, line (null: the whole file), weight, word, what, meaning}.
nlohmann::ordered_json finding_json(const LintFinding& finding);

/// List of lint findings, in the order of files and lines. If many rows have the same finding, only the first
/// finding is reported, with the number of rows.
class LintFindings {
 public:
  explicit LintFindings(std::string file) : file_(std::move(file)) {}
  void add(LintWeight weight, std::size_t line, const std::string& word, const std::string& what,
           const std::string& meaning = "");
  void error(std::size_t line, const std::string& word, const std::string& what,
             const std::string& meaning = "") {
    add(LintWeight::kError, line, word, what, meaning);
  }
  void warn(std::size_t line, const std::string& word, const std::string& what,
            const std::string& meaning = "") {
    add(LintWeight::kWarning, line, word, what, meaning);
  }
  void remark(std::size_t line, const std::string& word, const std::string& what,
              const std::string& meaning = "") {
    add(LintWeight::kRemark, line, word, what, meaning);
  }
  /// Adds a finding like add(). Further findings with the same `kind` are only counted.
  void add_of_kind(const std::string& kind, LintWeight weight, std::size_t line, const std::string& word,
                   const std::string& what, const std::string& meaning = "");
  bool any(LintWeight weight) const;
  std::vector<LintFinding> take();

 private:
  struct Entry {
    LintFinding finding;
    std::string kind;
    std::size_t more = 0, last_line = 0;
  };
  std::string file_;
  std::vector<Entry> entries_;
};

}  // namespace vernier::lint
