// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

/// What tells the effect of an input from one change of the machine at the time when the input changed.
/// Nothing, if no such change is a cause, or if no measured row has the first value of the input.
std::vector<std::string> advice_to_go_back(const model::Machine& machine, const model::Measurement& m,
                                           const diagnose::Diagnosis& d) {
  const effects::Choice& choice = d.candidates.front().candidate.choice;
  if (d.instrument != "set-up" || choice.inputs.empty() || !choice.runs.empty() || m.rows() == 0) return {};
  const std::string& name = choice.inputs.front();
  std::string value;
  const auto take = [&](const std::string& unit, const model::Column& column) {
    if (std::isfinite(column[0]))
      value = fmt::format(" ({:.4g}{}{})", column[0], unit.empty() ? "" : " ", unit);
  };
  if (const auto input = machine.find_input(name)) take(machine.inputs[*input].unit, m.states.input[*input]);
  for (const model::CandidateInput& one : m.candidates)
    if (one.name == name) take(one.unit, one.value);
  return {fmt::format(
      "Go back to the first value of {0}{1}, without touching the instrument, and measure the same poses "
      "again, in a run of their own. An effect of {0} is then as it was at first; a change of the machine or "
      "of its set-up stays. Next time measure at the first value, at the second, and again at the first.",
      name, value)};
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
    std::vector<std::string> list = advice(first.add, other.add);
    const std::vector<std::string> back = advice_to_go_back(machine, m, d);
    list.insert(list.end(), back.begin(), back.end());
    return list;
  }
  if (std::vector<std::string> back = advice_to_go_back(machine, m, d); !back.empty()) return back;
  if (std::vector<std::string> on_instrument = advice_on_instrument(d.instrument); !on_instrument.empty())
    return on_instrument;
  if (first.confounded_with.empty()) return {};
  return advice(first.add, first.confounded_with.front());
}

}  // namespace vernier::plan
