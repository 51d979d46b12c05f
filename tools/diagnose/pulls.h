// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/diagnose/evidence.h"
#include "tools/effects/candidate.h"
#include "tools/effects/gravity.h"

namespace vernier::diagnose {

/// Which of the functions that gravity has along a chain are worth a candidate: those that several axes
/// drive together (what one axis or a sum of parallel ones drives has forms of its own), few enough to tell.
class Pulls {
 public:
  explicit Pulls(const Evidence& evidence);

  /// Does a form ask for such a function?
  static bool asks(const effects::EffectForm& form);
  /// May such a form stand at this place? `toward` is tried for a bend only by variants().
  bool admits(const effects::EffectForm& form, const effects::DofPlace& place) const;
  /// A choice with its place, once for every bar and every mass that make a function of their own.
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
