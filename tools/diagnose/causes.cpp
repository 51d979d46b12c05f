// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/causes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "tools/effects/add_string.h"
#include "tools/effects/candidate.h"

namespace vernier::diagnose {
namespace {

constexpr std::array<std::pair<const char*, const char*>, 6> kInstrument = {{
    {"drift", "The instrument drifts."},
    {"step", "The readings of the instrument change in steps."},
    {"set-up", "The instrument was set up anew, or the machine changed, between the runs."},
    {"outliers", "Some readings are outliers."},
    {"clock", "Positions and readings were recorded at different times."},
    {"readings", "The readings do not fit this machine (wrong file, unit, sign or column)."},
}};

/// Makes the entries of effects.
class Causes {
 public:
  Causes(const Findings& found, std::size_t position)
      : found_(found),
        pool_(found.finder.pool()),
        axes_(found.machine),
        position_(position),
        first_(found.accepted[position]) {}

  /// Most likely first. `aliases`: other periods of the effect.
  std::vector<Cause> all(const std::vector<double>& aliases) const {
    const double own = found_.finder.evidence_for(first_);
    std::vector<Cause> causes = {entry(first_, pool_[first_].scored.scanned, own)};
    // One cause: FORMATS counts equal columns as no ambiguity.
    for (const std::string& name : of_other_axes(found_, position_))
      causes.front().description += fmt::format(", or {} with the opposite sign", name);
    for (const double alias : aliases)
      causes.push_back(entry(first_, {alias}, found_.finder.evidence_for(first_, {alias})));
    const std::vector<std::size_t> close = found_.close(position_);
    for (const Alternative& other : found_.alternatives[position_].other)
      if (std::find(close.begin(), close.end(), other.item) != close.end())
        causes.push_back(entry(other.item, pool_[other.item].scored.scanned, own - other.distance / 2));
    std::stable_sort(causes.begin(), causes.end(),
                     [](const Cause& a, const Cause& b) { return a.evidence > b.evidence; });
    return causes;
  }

 private:
  Cause entry(std::size_t item, const std::vector<double>& scanned, double evidence) const {
    Cause cause;
    cause.candidate = pool_.candidate(item);
    const effects::Choice& choice = cause.candidate->choice;
    cause.add = effects::add_string(found_.finder.evidence().machine(),
                                    effects::choice_at(*cause.candidate, scanned));
    cause.description = cause.candidate->spoken;
    cause.axis = effects::axis_of(axes_, choice);
    std::size_t at = 0;
    for (const effects::CandidateUnknown& unknown : effects::scanned_unknowns(*cause.candidate)) {
      if (unknown.kind == effects::UnknownKind::kPeriod && at < scanned.size()) {
        cause.period = scanned[at];
        const bool rotary = choice.axis && found_.machine.axes[*choice.axis].rotary;
        cause.description += fmt::format(", period {:.5g} {}", scanned[at], rotary ? "deg" : "mm");
      }
      ++at;
    }
    cause.evidence = evidence;
    return cause;
  }

  const Findings& found_;
  const Pool& pool_;
  const effects::AxisPlaces axes_;
  const std::size_t position_, first_;
};

/// Aliases of the first step's period.
std::vector<double> aliases_of(const Diagnosis& answer) {
  for (const CandidateFinding& one : answer.candidates)
    if (answer.ladder.size() > 1 && one.add == answer.ladder[1].add) return one.aliases;
  return {};
}

}  // namespace

std::vector<std::string> of_other_axes(const Findings& found, std::size_t position) {
  if (position >= found.alternatives.size()) return {};
  const Pool& pool = found.finder.pool();
  const std::vector<std::size_t>& same = found.alternatives[position].same;
  const effects::Choice& own = pool.candidate(found.accepted[position]).choice;
  const auto is_pair = [&](std::size_t item) { return pool.candidate(item).choice.axis2.has_value(); };
  std::vector<std::string> names;
  if (!own.axis || own.axis2 || std::none_of(same.begin(), same.end(), is_pair)) return names;
  for (const std::size_t item : same)
    if (const effects::Choice& other = pool.candidate(item).choice;
        other.effect == own.effect && other.form == own.form && other.axis != own.axis && !other.axis2)
      names.push_back(pool.candidate(item).spoken);
  return names;
}

Cause instrument_cause(const std::string& kind, double evidence) {
  Cause cause;
  cause.kind = kind;
  cause.evidence = evidence;
  for (const auto& [name, text] : kInstrument)
    if (kind == name) cause.description = text;
  return cause;
}

std::vector<Cause> causes_of_step(const Findings& found, std::size_t position) {
  return Causes(found, position).all({});
}

std::vector<Cause> causes_not_rejected(const Findings& found, const Diagnosis& answer) {
  std::vector<Cause> causes;
  const bool named = answer.verdict == Verdict::kMissingEffect || answer.verdict == Verdict::kAmbiguous;
  // Confirmed steps above a residual that is not noise are causes too; `remaining` states the rest.
  const bool part = answer.verdict == Verdict::kUnexplained && !answer.remaining.is_noise;
  if (!found.accepted.empty() && (named || part)) causes = Causes(found, 0).all(aliases_of(answer));
  if (answer.instrument.empty()) return causes;
  if (named && !causes.empty())
    causes.push_back(instrument_cause(answer.instrument, causes.front().evidence));
  else
    causes = {instrument_cause(answer.instrument, std::max(0.0, answer.noise.support / 2))};
  return causes;
}

}  // namespace vernier::diagnose
