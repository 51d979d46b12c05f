// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::text {

/// Returns the value if it is finite. Every comparison that leads to a verdict reads its numbers
/// with this function. what: name of the number, for the message. Throws std::logic_error for NaN
/// and infinity (exit status 70: no verdict is better than a wrong one). tool.
double decisive(double value, std::string_view what);

/// The assurance of a result; the names are those of tools/docs/assurances.md.
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

/// One rule that was tested. `value` and `limit` are finite. A yes-or-no rule counts the
/// violations (limit 0).
struct AssuranceRule {
  std::string rule;  // short name with hyphens
  double value = 0, limit = 0;
  std::string text;  // one sentence for people
  bool ok = true;
};

/// Assurance of a result. It holds if every tested rule is met. Without a rule it does not hold.
/// tool.
class Assurance {
 public:
  explicit Assurance(AssuranceKind kind) : kind_(kind) {}

  /// The rule is met if value <= limit. Throws std::logic_error if either is not finite.
  void at_most(std::string rule, double value, double limit, std::string text);
  /// The rule is met if value >= limit. Throws as `at_most`.
  void at_least(std::string rule, double value, double limit, std::string text);
  /// The rule is met if `ok` is true: value is 0, else 1; the limit is 0.
  void require(std::string rule, bool ok, std::string text);
  /// Adds a sentence about something that the result does not cover.
  void not_covered(std::string text);

  AssuranceKind kind() const { return kind_; }
  bool holds() const;
  /// Returns the rules that are not met; if all are met, all of them.
  std::vector<AssuranceRule> because() const;
  const std::vector<std::string>& uncovered() const { return uncovered_; }

  /// {"kind", "holds", "because": [{"rule", "value", "limit", "text"}], "not_covered": []}
  nlohmann::ordered_json json() const;

 private:
  AssuranceKind kind_;
  std::vector<AssuranceRule> rules_;
  std::vector<std::string> uncovered_;
};

}  // namespace vernier::text
