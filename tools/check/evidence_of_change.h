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
  double change = 0, std = 0;  // change of the parameter and its standard uncertainty, in the unit of the
                               // parameter
  double weight = 0;           // share of this parameter in the evidence, 0..1
  std::size_t since = 0;       // index of the first check that shows the change
};

struct CheckAnswer {
  CheckVerdict verdict = CheckVerdict::kValid;
  double evidence = 1;  // e-value of all checks for a change; it is valid for any number of earlier checks
  double alarm = 100;   // alarm threshold: a change is reported if the e-value exceeds it; 1 / (0.8 false
                        // alarms)
  double noise_p = 1;   // p-value of the noise in the last check; it is reported below 0.2 false alarms / (k
                        // (k+1))
  std::vector<Change> changed;              // possible changes, the most probable first; empty if no change
                                            // is reported
  std::vector<std::string> not_told_apart;  // names of other parameters that explain the readings nearly as
                                            // well
  std::vector<std::string> not_seen;        // tested parameters that do not affect these readings
  std::vector<Change> resolved;  // smallest detectable change (std) of each parameter that affects the
                                 // readings of the last check
  std::string explanation;
  text::Assurance assurance{text::AssuranceKind::kCheck};  // the assurance holds if the verdict is kValid
};

/// Tests the complete history of checks of a machine as one sequential test. The statistic is a mixture of
/// likelihood ratios of a change against no change (Robbins 1970; Grünwald, de Heide and Koolen 2024). The
/// mixture is over two unknowns: the check at which the change occurred, and the parameter that changed. The
/// likelihood ratios include the uncertainty of the parameters after the fit, by integration. If nothing
/// changes, the probability that the statistic ever exceeds `alarm` during the lifetime of a machine is at
/// most 1 / `alarm`, for any number of checks (Ville 1939). The limit 1 / `alarm` is valid under one
/// condition: the readings are normal, with the stated uncertainty and the correlation of the fit (the noise
/// in <fitted>; independent if <fitted> has no noise). If a check did not test a parameter, the likelihood
/// ratio of this parameter is 1 in that check. The weight of a parameter is fixed before its first reading.
/// A check is excluded from the evidence if its readings scatter more than the stated uncertainty. `checks`:
/// at least one check of one machine, in time order. Throws std::logic_error if a number that the decision
/// needs is not finite.
CheckAnswer judge(const model::Machine& machine, const std::vector<CheckRecord>& checks, double false_alarms);

}  // namespace vernier::check
