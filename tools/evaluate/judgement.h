// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/text/assurance.h"

namespace vernier::evaluate {

/// Decision rule of ISO 14253-1. The tolerance is met if the value plus its expanded uncertainty is within
/// the tolerance. The tolerance is not met if the value minus its expanded uncertainty is beyond the
/// tolerance. Numbers whose difference is only rounding (1e-12 of the tolerance) count as equal.
enum class Conformity { kMet, kNotMet, kUndecided };
/// Applies the decision rule of ISO 14253-1 to a value. `value`, `tolerance`, `expanded_uncertainty`: all in
/// the same unit. Throws std::logic_error if an argument is not finite.
Conformity conformity(double value, double tolerance, double expanded_uncertainty);
/// Returns the text of a decision: "met", "not met", "not decided (within the uncertainty)".
const char* conformity_text(Conformity conformity);

/// A characteristic for which a tolerance was given. All numbers are in the printed unit.
struct JudgedValue {
  std::string name;
  std::optional<double> value;     // nullopt: these readings do not contain the characteristic
  std::optional<double> expanded;  // expanded uncertainty, k = 2; nullopt: unknown, so that the value alone
                                   // is tested
  double tolerance = 0;
};

/// Number of decimals in the output of commands, for um or arcsec.
inline constexpr int kPrintedDigits = 3;

struct JudgedText {
  std::string value, uncertainty, tolerance;
};
/// Returns the numbers of a decision as text, with at least `least` digits after the decimal point. If
/// rounding would make the printed numbers contradict the decision, more digits are printed. A missing value
/// is printed as "–".
JudgedText judged_text(const JudgedValue& one, int least);

/// Returns an assurance, which holds if every given tolerance is met. `unit`: unit of the numbers in the
/// sentences.
text::Assurance assurance_of(const std::vector<JudgedValue>& all, const std::string& unit);

}  // namespace vernier::evaluate
