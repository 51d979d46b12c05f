// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tools/model/measurement.h"
#include "tools/plan/types.h"

namespace vernier::plan {

/// Explains in one sentence why the planned rows distinguish the two effects: the state that the existing
/// rows lack, and the influence of this state on each effect. Keeps references.
class Explanation {
 public:
  /// `existing`: the rows that the plan builds on, bound to the plan's machine.
  Explanation(const Plan& plan, const model::Measurement& existing);
  std::string sentence() const;

 private:
  /// A changed state: the planned rows at its farthest level, and the same rows with the state
  /// unchanged.
  struct Contrast {
    std::string where;     // "at T_bed 15 and 35 degC (so far 20 to 25)"
    std::string farthest;  // "35 degC"
    model::Measurement planned, as_was;
    bool usable = false;
  };
  struct Answer {
    double a = 1, b = 1;  // size of the effect, planned divided by unchanged
  };
  std::vector<Contrast> contrasts() const;
  Contrast speed() const;
  Contrast sense(std::size_t axis) const;
  Contrast level(const std::string& name, const std::string& unit, const model::Column& planned,
                 const model::Column& old, const std::function<void(model::Measurement&, double)>& set) const;
  Answer answer(const Contrast& contrast) const;
  double ratio(const FittedRival& rival, const Contrast& contrast) const;

  const Plan& plan_;
  const model::Measurement& existing_;
};

}  // namespace vernier::plan
