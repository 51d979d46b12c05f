// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/advice.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/plan/plan.h"
#include "tools/plan/uneven.h"
#include "tools/text/error.h"

namespace vernier::plan {
namespace {

/// What tells an effect of the instrument from an effect of the machine.
std::vector<std::string> advice_on_instrument(const std::string& instrument) {
  if (instrument == "set-up")
    return {
        "Measure several runs without touching the instrument, and state this in a column `setup` with one "
        "label for these runs. A shift between runs of one set-up is an error of the machine."};
  if (instrument == "drift")
    return {
        "Test the instrument: read a fixed mark with it for one day, and record times and temperatures. If "
        "the readings of the mark change as much, the instrument drifts. Do not add these readings to the "
        "measurement files."};
  return {};
}

}  // namespace

std::vector<std::string> advice_for(const std::string& text, const model::Machine& machine,
                                    const model::Measurement& m, const diagnose::Diagnosis& d,
                                    const std::vector<effects::Effect>& effects) {
  if (d.verdict == diagnose::Verdict::kInstrument) return advice_on_instrument(d.instrument);
  if (d.verdict != diagnose::Verdict::kAmbiguous || d.candidates.empty()) return {};
  const diagnose::CandidateFinding& first = d.candidates.front();
  const std::string& id = first.candidate.choice.effect->id;
  // A finding remains valid even if it gives no advice.
  const auto advice = [&](const std::string& a, const std::string& b) -> std::vector<std::string> {
    try {
      return next_measurement(text, machine, m, a, b, effects);
    } catch (const text::InputError& error) {
      return {fmt::format("no measurement was found that distinguishes {} from {}: {}", a, b, error.what())};
    }
  };
  std::vector<std::string> uneven;
  for (const diagnose::CandidateFinding& one : d.candidates)
    if (!one.aliases.empty()) uneven.push_back(uneven_sentence(machine, m, one));
  if (!uneven.empty()) return uneven;
  for (const diagnose::CandidateFinding& other : d.candidates) {
    const auto& names = other.confounded_with;
    if (&other == &first || std::find(names.begin(), names.end(), id) == names.end()) continue;
    return advice(first.add, other.add);
  }
  if (std::vector<std::string> on_instrument = advice_on_instrument(d.instrument); !on_instrument.empty())
    return on_instrument;
  if (first.confounded_with.empty()) return {};
  return advice(first.add, first.confounded_with.front());
}

}  // namespace vernier::plan
