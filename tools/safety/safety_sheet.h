// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/model/machine.h"

namespace vernier::safety {

/// Rules that a machine file must meet before its correction may run. Correction images contain the numbers
/// of these rules. The number of a rule therefore never changes.
enum class SafetyRule : std::uint8_t {
  kCorrection = 0,     // largest correction of an axis
  kMaxCorrection = 1,  // correction relative to the axis' own limit (maxcorrection), which would truncate it
  kCancellation = 2,   // terms that are much larger than their sum
  kUncertainty = 3,    // uncertainty of the correction in the working range of the machine, with its tools
  kMeasuredRange = 4,  // extrapolation beyond the measured range of the axes
  kInputRange = 5,  // extrapolation beyond the measured range of temperatures, other inputs, time and visits
  kSetUp = 6,       // a set-up of the measurement that would affect an axis
  kConverged = 7,   // the fit has converged
  kResidual = 8,    // residual of the fit
  kOutlier = 9,     // one reading that differs from all other readings
  kCheckRows = 10,  // held-out check rows, compared with the nominal machine
  kDisturbed = 11,  // a disturbance of the instrument, or a residual far above its noise
  kBound = 12,      // proved error of the image divided by its correction; only `compile` tests this rule
};
inline constexpr std::size_t kSafetyRuleCount = 13;  // number of rules on the sheet
const char* rule_name(SafetyRule rule);
std::optional<SafetyRule> rule_named(const std::string& name);
/// Returns the names of all rules in the order of their numbers, with `separator` between two names.
std::string rule_names(const std::string& separator);

struct SafetyFinding {
  SafetyRule rule = SafetyRule::kCorrection;
  std::optional<double> value;  // nullopt if the machine file does not contain the value (for example a
                                // machine that was never fitted)
  double limit = 0;
  std::string unit;
  bool ok = true;
  bool accepted = false;  // the rule is not met, and the user accepts this
  std::string culprit;    // parameter, axis, input or reading with the largest contribution
  std::string reason;     // reason for the limit
  std::string remedy;     // what the user can do instead of accepting the rule; can be empty
};

/// The safety sheet of one machine, which `compile`, `export`, `upload` and the workbench use.
struct SafetySheet {
  std::vector<SafetyFinding> findings;  // one finding for each rule, in the order of the rules' numbers
  /// Names of parameters that were added or changed by hand after the fit. The uncertainty of a parameter
  /// that was changed by hand is the difference between its present value and its fitted value.
  std::vector<std::string> stale;
  /// The result of not_measured() for this machine.
  std::string not_measured;
  /// Adds the finding of one rule to the sheet. `remedy`: of this culprit; empty: the remedy of the rule.
  /// Throws std::logic_error if the value is not finite.
  void judge(SafetyRule rule, std::optional<double> value, std::string culprit,
             const std::vector<SafetyRule>& accepted, std::string remedy = {});
  bool ok() const;
  /// Returns the names of the rules without a value: nothing states the quantity, so the rule judged nothing.
  std::vector<std::string> not_known() const;
  std::uint32_t accepted_mask() const;  // bit n is rule n
  /// Returns one line of text: the rule with the largest excess over its limit, its value, limit and culprit,
  /// and then the other rules that are not met. The returned line is empty if all rules of the safety sheet
  /// are met.
  std::string refusal() const;
};

/// Evaluates a machine over its <volume> (or the ranges of its axes) and with its <tools>. The inputs have
/// their reference values. The uncertainty is also evaluated at both ends of the measured range of each
/// input. `accepted`: rules that the user accepts although they are not met. Throws InputError if an axis has
/// no range.
SafetySheet safety_sheet(const model::Machine& machine, const std::vector<SafetyRule>& accepted = {});

/// Returns the parameters and columns of tables that the readings of the last fit do not determine, separated
/// by commas, as `fit --hold` reads them: all entries stay at nominal; or, for the column of a table, half of
/// its entries or more are as uncertain as nominal, and no entry comes from the data. Empty without a fit.
std::string not_measured(const model::Machine& machine);

/// Converts names of rules to rules. Throws InputError if a name is not the name of a rule. The message lists
/// all rules.
std::vector<SafetyRule> rules_named(const std::vector<std::string>& names);

}  // namespace vernier::safety
