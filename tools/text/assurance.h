// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::text {

/// Returns `value` if it is finite. Every comparison that determines a verdict reads its numbers through
/// decisive(). `what`: name of the number, for the error message. Throws std::logic_error for NaN and
/// infinity (exit status 70), because no verdict is better than a wrong verdict.
double decisive(double value, std::string_view what);

/// Kind of result to which an assurance belongs. The names are those of tools/docs/assurances.md.
enum class AssuranceKind : std::uint8_t {
  kFit,
  kDiagnose,
  kCheck,
  kCompile,
  kExport,
  kUpload,
  kRollout,
  kConformity,
  kEvaluate,
  kSolve,
  kPlan,
};
const char* assurance_name(AssuranceKind kind);

/// One rule of an assurance that was tested. `value` and `limit` are finite. For a yes-or-no question,
/// `value` is the number of failures and `limit` is 0.
struct AssuranceRule {
  std::string rule;  // short name of the rule, with hyphens
  double value = 0, limit = 0;
  std::string text;  // one sentence for people
  bool ok = true;
};

/// Assurance of a result: the list of tested rules. The assurance holds if every tested rule is met. An
/// assurance without any rule does not hold.
class Assurance {
 public:
  explicit Assurance(AssuranceKind kind) : kind_(kind) {}

  /// Adds a rule that is met if value <= limit. Throws std::logic_error if value or limit is not finite.
  void at_most(std::string rule, double value, double limit, std::string text);
  /// Adds a rule that is met if value >= limit. Throws std::logic_error if value or limit is not finite.
  void at_least(std::string rule, double value, double limit, std::string text);
  /// Adds a rule that is met if `ok` is true. The value of the rule is 0 if it is met and 1 otherwise; its
  /// limit is 0.
  void require(std::string rule, bool ok, std::string text);
  /// Adds a sentence about a question that the result does not cover.
  void not_covered(std::string text);

  AssuranceKind kind() const { return kind_; }
  bool holds() const;
  /// Returns the rules that are not met. If all rules of the assurance are met, the function returns all
  /// rules.
  std::vector<AssuranceRule> because() const;
  const std::vector<std::string>& uncovered() const { return uncovered_; }

  /// Returns the assurance as JSON: {"kind", "holds", "because": [{"rule", "value", "limit", "text"}],
  /// "not_covered": []}
  nlohmann::ordered_json json() const;

 private:
  AssuranceKind kind_;
  std::vector<AssuranceRule> rules_;
  std::vector<std::string> uncovered_;
};

}  // namespace vernier::text
