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
  Suspect suspect;
  double change = 0, std = 0;  // in the suspect's unit
  double weight = 0;           // of the evidence, 0..1
  std::size_t since = 0;       // index of the first check that shows it
};

struct CheckAnswer {
  CheckVerdict verdict = CheckVerdict::kValid;
  double evidence = 1;  // e-value: by how much the checks speak for a change, whatever was looked at before
  double alarm = 100;   // above which a change is reported: 1 / (0.8 false alarms)
  double noise_p = 1;   // chance of the last check's noise, reported below 0.2 false alarms / (k (k+1))
  std::vector<Change> changed;              // the likeliest first; nothing where none is told
  std::vector<std::string> not_told_apart;  // that explain it nearly as well
  std::vector<std::string> not_seen;        // suspects that these readings do not move by
  std::vector<Change> resolved;  // how small a change of each seen parameter the last check would show: std
  std::string explanation;
  text::Assurance assurance{text::AssuranceKind::kCheck};  // holds where the verdict is valid
};

/// The whole history as one sequential test: the mixture, over the check since which and the suspect by
/// which, of the likelihood ratios of a change against none (Robbins 1970; Grünwald, de Heide and Koolen
/// 2024), with what the fit itself does not know of the parameters integrated out. If nothing changes it
/// exceeds `alarm` in the lifetime of a machine with that probability at most, however often one looks
/// (Ville 1939), under normal readings of the stated uncertainty that hang together as those of the fit did
/// (<fitted>'s noise; independent where it has none). A suspect that an earlier check did not look at has a
/// ratio of 1 there, and its weights are fixed before its first reading. A check whose readings scatter more
/// than stated is left out of the evidence. checks: in the order of time, of one machine, at least one.
/// Throws std::logic_error where a figure that decides is not finite. tool.
CheckAnswer judge(const model::Machine& machine, const std::vector<CheckRecord>& checks, double false_alarms);

}  // namespace vernier::check
