// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tools/model/measurement.h"
#include "tools/plan/types.h"

namespace vernier::plan {

/// Explains in one sentence why the planned rows distinguish the two effects: the state of the machine that
/// the existing rows do not contain, and the influence of this state on each effect. The Explanation keeps
/// references to its arguments.
class Explanation {
 public:
  /// `existing`: the rows on which the plan is based, in the form for the machine of the plan.
  Explanation(const Plan& plan, const model::Measurement& existing);
  std::string sentence() const;

 private:
  /// A state that the plan changes: the planned rows at the farthest level of this state, and the same rows
  /// with the state unchanged.
  struct Contrast {
    std::string where;     // description of the levels: "at T_bed 15 and 35 degC (so far 20 to 25)"
    std::string farthest;  // farthest level: "35 degC"
    model::Measurement planned, as_was;
    bool usable = false;
  };
  struct Answer {
    double a = 1, b = 1;  // ratio of the size of each effect: with the planned state divided by with the
                          // unchanged state
  };
  std::vector<Contrast> contrasts() const;
  Contrast speed() const;
  Contrast sense(std::size_t axis) const;
  Contrast level(const std::string& name, const std::string& unit, const model::Column& planned,
                 const model::Column& old, const std::function<void(model::Measurement&, double)>& set) const;
  Answer answer(const Contrast& contrast) const;
  double ratio(const FittedHypothesis& hypothesis, const Contrast& contrast) const;

  const Plan& plan_;
  const model::Measurement& existing_;
};

}  // namespace vernier::plan
