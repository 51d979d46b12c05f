// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/diagnose/propose/evidence.h"
#include "tools/effects/candidate.h"
#include "tools/effects/gravity.h"

namespace vernier::diagnose {

/// Selects the gravity functions along a chain that become candidates. Several axes together drive these
/// functions, and the readings can distinguish them. Gravity functions of one axis, or of a sum of parallel
/// axes, have separate forms in the catalogue.
class Pulls {
 public:
  explicit Pulls(const Evidence& evidence);

  /// True if a form of an effect needs a gravity function along the chain.
  static bool asks(const effects::EffectForm& form);
  /// True if a form whose term contains a gravity function can act at the location `place`. For a bend, only
  /// variants() tests the directions `toward`.
  bool admits(const effects::EffectForm& form, const effects::DofPlace& place) const;
  /// Returns copies of a choice with its location, one copy for every bar and every mass whose gravity
  /// function is different from the others.
  std::vector<effects::Choice> variants(const effects::Choice& choice) const;

 private:
  bool is_told(const std::optional<effects::Wave>& wave, bool several) const;
  void with_masses(const effects::Choice& choice, std::vector<effects::Choice>& list) const;
  Eigen::VectorXd column(const effects::Wave& wave) const;

  const Evidence& evidence_;
  const model::Machine& machine_;
  effects::GravityChain gravity_;
  effects::AxisPlaces axes_;
};

}  // namespace vernier::diagnose
