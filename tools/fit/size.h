// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>

#include "tools/fit/least_squares/problem.h"
#include "tools/fit/settle.h"
#include "tools/fit/types.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"

namespace vernier::fit {

/// Direction in the parameters that makes the whole machine larger: the change of each parameter per relative
/// change 1 of the size. A length parameter changes in proportion to its value; an angle does not change.
struct SizeDirection {
  Eigen::VectorXd start, at_start, power;
  Eigen::VectorXd at(const Eigen::VectorXd& point) const {
    return at_start + power.cwiseProduct(point - start);
  }
};

/// Returns the size direction at `point`; nullopt if linear axes or fixed lengths determine the size, so that
/// the free parameters cannot change it.
std::optional<SizeDirection> size_direction(const model::Machine& machine, const model::Measurement& rows,
                                            const model::ParameterSet& parameters,
                                            const Convention& convention, const Eigen::VectorXd& point);

/// Finds the lengths that determine the size of the machine. The inputs are the readings at `point`, the
/// scales of all other parameters, and their stated priors. If the readings give no more information about
/// the size than the convention does, the size is fixed. If the size of the machine is fixed, the cost of
/// `problem` does not depend on the size. Returns nullopt if there are no rows with `same` or `on` and no
/// readings of a board.
std::optional<SizeOfMachine> decide_size(FitProblem& problem, const model::Machine& machine,
                                         const model::ParameterSet& parameters, const Convention& convention,
                                         const StatedPriors& stated, const Eigen::VectorXd& point);

/// Returns the text of the finding `size-unknown`, or a sentence about the lengths that determine the size.
std::string size_sentence(const SizeOfMachine& size);

}  // namespace vernier::fit
