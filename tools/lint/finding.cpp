// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/lint/finding.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/text/words.h"

namespace vernier::lint {

const char* weight_name(LintWeight weight) {
  switch (weight) {
    case LintWeight::kError:
      return "error";
    case LintWeight::kWarning:
      return "warning";
    case LintWeight::kRemark:
      return "remark";
  }
  return "";
}

std::string in_one_line(const LintFinding& finding) {
  std::string line = text::printable(finding.file);
  if (finding.line > 0) line += ":" + std::to_string(finding.line);
  line += std::string(": ") + weight_name(finding.weight) + ": ";
  if (!finding.word.empty()) line += "\"" + text::quotable(finding.word) + "\": ";
  line += finding.what;
  return text::shown_message(finding.meaning.empty() ? line : line + " -- " + finding.meaning);
}

nlohmann::ordered_json finding_json(const LintFinding& finding) {
  using Json = nlohmann::ordered_json;
  return {{"file", finding.file},
          {"line", finding.line > 0 ? Json(finding.line) : Json(nullptr)},
          {"weight", weight_name(finding.weight)},
          {"word", finding.word},
          {"what", finding.what},
          {"meaning", finding.meaning}};
}

void LintFindings::add(LintWeight weight, std::size_t line, const std::string& word, const std::string& what,
                       const std::string& meaning) {
  entries_.push_back({{file_, line, weight, word, what, meaning}, "", 0, 0});
}

void LintFindings::add_of_kind(const std::string& kind, LintWeight weight, std::size_t line,
                               const std::string& word, const std::string& what, const std::string& meaning) {
  for (Entry& entry : entries_)
    if (entry.kind == kind) {
      ++entry.more;
      entry.last_line = line;
      return;
    }
  entries_.push_back({{file_, line, weight, word, what, meaning}, kind, 0, line});
}

bool LintFindings::any(LintWeight weight) const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [&](const Entry& entry) { return entry.finding.weight == weight; });
}

std::vector<LintFinding> LintFindings::take() {
  std::vector<LintFinding> list;
  for (Entry& entry : entries_) {
    if (entry.more > 0)
      entry.finding.what += fmt::format("; the same finding occurs {} more time{}, last in line {}",
                                        entry.more, entry.more == 1 ? "" : "s", entry.last_line);
    list.push_back(std::move(entry.finding));
  }
  entries_.clear();
  std::stable_sort(list.begin(), list.end(),
                   [](const LintFinding& a, const LintFinding& b) { return a.line < b.line; });
  return list;
}

}  // namespace vernier::lint
