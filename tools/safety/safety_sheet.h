// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/model/machine.h"

namespace vernier::safety {

/// Rules that a machine file must meet before its correction may run. Images contain these numbers: a number
/// never changes.
enum class SafetyRule : std::uint8_t {
  kCorrection = 0,     // how far an axis would be moved
  kMaxCorrection = 1,  // against the axis' own limit, which would cut it off
  kCancellation = 2,   // terms that are much larger than their sum
  kUncertainty = 3,    // how well the correction is known where the machine works, with its tools
  kMeasuredRange = 4,  // extrapolation beyond the measured range
  kInputRange = 5,     // the same for temperatures and other inputs
  kSetUp = 6,          // set-up of the measurement that would reach an axis
  kConverged = 7,      // the fit came to an end
  kResidual = 8,       // residual of the fit
  kOutlier = 9,        // one reading against all the others
  kCheckRows = 10,     // rows that the fit has not seen, against the nominal machine
  kDisturbed = 11,     // disturbance of the instrument, or a residual far above its noise
  kBound = 12,         // proved error of the image over its correction; tested by `compile` only
};
inline constexpr std::size_t kSafetyRuleCount = 13;  // rules of the sheet
const char* rule_name(SafetyRule rule);
std::optional<SafetyRule> rule_named(const std::string& name);

struct SafetyFinding {
  SafetyRule rule = SafetyRule::kCorrection;
  std::optional<double> value;  // nullopt if the file does not give it (a machine that was never fitted)
  double limit = 0;
  std::string unit;
  bool ok = true;
  bool accepted = false;  // not ok, and the user takes it
  std::string culprit;    // parameter, axis, input or reading that counts most
  std::string reason;     // why there is a limit
};

/// The safety sheet of one machine, for `compile`, `export`, `upload` and the workbench.
struct SafetySheet {
  std::vector<SafetyFinding> findings;  // one per rule, in the order of their numbers
  /// Parameters that were added or set by hand since the fit. The uncertainty of such a parameter is the size
  /// of the difference between its present value and its value in the fit.
  std::vector<std::string> stale;
  /// Adds a rule's finding. Throws std::logic_error for a value that is not finite.
  void judge(SafetyRule rule, std::optional<double> value, std::string culprit,
             const std::vector<SafetyRule>& accepted);
  bool ok() const;
  std::uint32_t accepted_mask() const;  // bit n: rule n
  /// Returns one line: the rule with the largest excess, its value, limit and culprit, and then the other
  /// rules that are not met. The line is empty if all rules are met.
  std::string refusal() const;
};

/// Evaluates a machine over its <volume> (else the ranges of its axes) and with its <tools>, at the
/// references of its inputs. The uncertainty is also evaluated at both ends of the measured range of each
/// input. `accepted`: rules that the user overrides. Throws InputError for an axis without a range.
SafetySheet safety_sheet(const model::Machine& machine, const std::vector<SafetyRule>& accepted = {});

/// Converts names of rules to rules. Throws InputError for a rule that does not exist; the error lists the
/// rules that exist.
std::vector<SafetyRule> rules_named(const std::vector<std::string>& names);

}  // namespace vernier::safety
