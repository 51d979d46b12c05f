// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/other_hypotheses.h"
#include "tools/effects/add_string.h"

#include <algorithm>
#include <tuple>

namespace vernier::plan {
namespace {

/// A diagnosis keeps candidates within a distance of 6; a candidate worse by twice that will hardly return
/// with a few new rows.
constexpr double kNear = 12;

using Cause = std::tuple<std::string, std::optional<std::size_t>, std::vector<std::string>>;
Cause cause_of(const effects::Candidate& candidate) {
  return {candidate.choice.effect->id, candidate.choice.axis, candidate.choice.inputs};
}

}  // namespace

std::vector<FittedHypothesis> find_other_hypotheses(const effects::MachineText& model,
                                                    const model::Measurement& measurement,
                                                    const std::vector<const FittedHypothesis*>& named,
                                                    const std::vector<effects::Effect>& effects,
                                                    std::size_t most) {
  const diagnose::Evidence evidence(model.machine, measurement);
  const std::vector<diagnose::ScannedCandidate> list = diagnose::enumerate_candidates(evidence, effects);
  diagnose::Scanner scanner(evidence, list);
  const Eigen::MatrixXd none(evidence.residual().size(), 0);
  std::vector<diagnose::Scored> scored = scanner.scan(diagnose::AcceptedColumns(none), {});
  std::sort(scored.begin(), scored.end(), [&](const diagnose::Scored& x, const diagnose::Scored& y) {
    return value_of(x, evidence) > value_of(y, evidence);
  });
  std::set<Cause> seen;
  for (const FittedHypothesis* hypothesis : named) seen.insert(cause_of(hypothesis->candidate));
  std::vector<FittedHypothesis> found;
  for (const diagnose::Scored& item : scored) {
    if (found.size() >= most || value_of(item, evidence) < value_of(scored.front(), evidence) - kNear) break;
    const effects::Candidate& candidate = list[item.candidate].candidate;
    if (!seen.insert(cause_of(candidate)).second) continue;
    diagnose::Scored refined = item;
    scanner.refine(refined, none);
    found.push_back(fit_hypothesis(
        model, evidence, measurement,
        effects::add_string(evidence.machine(), effects::choice_at(candidate, refined.scanned)), effects));
  }
  return found;
}

}  // namespace vernier::plan
