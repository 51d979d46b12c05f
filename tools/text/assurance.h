// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::text {

/// Returns the value if it is finite. Every comparison for a verdict reads its numbers through decisive().
/// what: name of the number, for the message. Throws std::logic_error for NaN and infinity (exit status 70:
/// no verdict is better than a wrong verdict).
double decisive(double value, std::string_view what);

/// Kind of an assurance; the names are those of tools/docs/assurances.md.
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

/// One rule that was tested. `value` and `limit` are finite; for a yes-or-no question, value counts the
/// failures (limit 0).
struct AssuranceRule {
  std::string rule;  // short name with hyphens
  double value = 0, limit = 0;
  std::string text;  // one sentence for people
  bool ok = true;
};

/// The assurance of a result: the result is assured if every tested rule is met. An assurance without a rule
/// does not hold.
class Assurance {
 public:
  explicit Assurance(AssuranceKind kind) : kind_(kind) {}

  /// The rule is met if value <= limit. Throws std::logic_error if value or limit is not finite.
  void at_most(std::string rule, double value, double limit, std::string text);
  /// The rule is met if value >= limit. Throws as `at_most`.
  void at_least(std::string rule, double value, double limit, std::string text);
  /// The rule is met if `ok` is true: then value is 0, else 1; the limit is 0.
  void require(std::string rule, bool ok, std::string text);
  /// Something that the result does not cover, as a sentence.
  void not_covered(std::string text);

  AssuranceKind kind() const { return kind_; }
  bool holds() const;
  /// The rules that are not met; if all are met, all rules.
  std::vector<AssuranceRule> because() const;
  const std::vector<std::string>& uncovered() const { return uncovered_; }

  /// Returns {"kind", "holds", "because": [{"rule", "value", "limit", "text"}], "not_covered": []}
  nlohmann::ordered_json json() const;

 private:
  AssuranceKind kind_;
  std::vector<AssuranceRule> rules_;
  std::vector<std::string> uncovered_;
};

}  // namespace vernier::text
