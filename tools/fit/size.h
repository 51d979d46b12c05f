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

/// The change of the parameters that makes the whole machine larger by one share, in parameter units per 1.
/// A length changes by itself, an angle does not.
struct SizeDirection {
  Eigen::VectorXd start, at_start, power;
  Eigen::VectorXd at(const Eigen::VectorXd& point) const {
    return at_start + power.cwiseProduct(point - start);
  }
};

/// Returns the direction at `point`; nullopt: the free parameters cannot change the size, because linear axes
/// or fixed lengths determine the size.
std::optional<SizeDirection> size_direction(const model::Machine& machine, const model::Measurement& rows,
                                            const model::ParameterSet& parameters,
                                            const Convention& convention, const Eigen::VectorXd& point);

/// Finds the lengths that determine the size of the machine, from the readings at `point`, the scales of
/// all other parameters, and their stated priors. If the readings give no more information on the size than
/// the convention, the size is fixed: `problem` then does not depend on the size. Only for rows with `same`
/// or `on`, or with readings of a board; nullopt if there are no such rows.
std::optional<SizeOfMachine> decide_size(FitProblem& problem, const model::Machine& machine,
                                         const model::ParameterSet& parameters, const Convention& convention,
                                         const StatedPriors& stated, const Eigen::VectorXd& point);

/// Returns the sentence of the finding `size-unknown`, or the sentence about the lengths that determine the
/// size.
std::string size_sentence(const SizeOfMachine& size);

}  // namespace vernier::fit
