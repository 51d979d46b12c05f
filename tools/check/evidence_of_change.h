// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/check/check_record.h"
#include "tools/model/machine.h"
#include "tools/text/assurance.h"

namespace vernier::check {

enum class CheckVerdict : std::uint8_t { kValid, kChanged, kInstrument, kTooLittle };
const char* verdict_name(CheckVerdict verdict);

struct Change {
  CheckedQuantity quantity;
  double change = 0, std = 0;  // in the parameter's unit
  double weight = 0;           // of the evidence, 0..1
  std::size_t since = 0;       // index of the first check that shows it
};

struct CheckAnswer {
  CheckVerdict verdict = CheckVerdict::kValid;
  double evidence = 1;  // e-value of the checks for a change; valid for any number of earlier checks
  double alarm = 100;   // above which a change is reported: 1 / (0.8 false alarms)
  double noise_p = 1;   // chance of the last check's noise, reported below 0.2 false alarms / (k (k+1))
  std::vector<Change> changed;              // the likeliest first; empty if no change is reported
  std::vector<std::string> not_told_apart;  // that explain it nearly as well
  std::vector<std::string> not_seen;        // tested parameters that do not affect these readings
  std::vector<Change> resolved;  // how small a change of each seen parameter the last check would show: std
  std::string explanation;
  text::Assurance assurance{text::AssuranceKind::kCheck};  // holds where the verdict is valid
};

/// Tests the whole history of checks as one sequential test. The statistic is a mixture of likelihood ratios
/// of a change against no change (Robbins 1970; Grünwald, de Heide and Koolen 2024). The mixture is over the
/// check at which the change occurred and over the tested parameter. The uncertainty of the parameters after
/// the fit is integrated out. If nothing changes, the statistic exceeds `alarm` during the lifetime of a
/// machine with a probability of 1 / `alarm` at most, for any number of checks (Ville 1939). Condition:
/// normal readings of the stated uncertainty with the correlation of the fit (the noise of <fitted>;
/// independent if <fitted> has none). If a check did not test a parameter, the likelihood ratio of this
/// parameter is 1 for that check. The weights of a parameter are fixed before its first reading. A check
/// whose readings scatter more than stated is excluded from the evidence. checks: in the order of time, of
/// one machine, at least one check. Throws std::logic_error if a number that the decision needs is not
/// finite.
CheckAnswer judge(const model::Machine& machine, const std::vector<CheckRecord>& checks, double false_alarms);

}  // namespace vernier::check
