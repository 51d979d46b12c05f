// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/text/assurance.h"

namespace vernier::evaluate {

/// Decision rule of ISO 14253-1. The tolerance is met if the value plus its expanded uncertainty is within
/// the tolerance. The tolerance is not met if the value minus its expanded uncertainty is beyond the
/// tolerance. Numbers that differ by rounding (1e-12 of the tolerance) are equal.
enum class Conformity { kMet, kNotMet, kUndecided };
/// Applies the decision rule. value, tolerance, expanded_uncertainty: in one unit. Throws std::logic_error if
/// an argument is not finite.
Conformity conformity(double value, double tolerance, double expanded_uncertainty);
/// "met", "not met", "not decided (within the uncertainty)".
const char* conformity_text(Conformity conformity);

/// A characteristic that a tolerance was given for; all numbers in the unit that is printed.
struct JudgedValue {
  std::string name;
  std::optional<double> value;     // nullopt: these readings do not contain it
  std::optional<double> expanded;  // uncertainty, k = 2; nullopt: not known, the value alone is tested
  double tolerance = 0;
};

/// Decimals in the output of commands, um or arcsec.
inline constexpr int kPrintedDigits = 3;

struct JudgedText {
  std::string value, uncertainty, tolerance;
};
/// Returns the numbers of a judgement with `least` digits after the decimal point. More digits are used if
/// the printed numbers would not agree with the verdict. A missing value is "–".
JudgedText judged_text(const JudgedValue& one, int least);

/// The assurance holds if every given tolerance is met. unit: unit of the numbers, for the sentences.
text::Assurance assurance_of(const std::vector<JudgedValue>& all, const std::string& unit);

}  // namespace vernier::evaluate
