// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::exchange {

/// Letters of the axes of a machine with three axes.
inline constexpr std::array<const char*, 3> kLetters = {"X", "Y", "Z"};

/// The axes X, Y and Z of a three-axis machine, and their working ranges, mm.
struct ThreeAxes {
  std::array<std::size_t, 3> axis{};
  std::array<double, 3> low{}, high{};
};

/// Throws InputError if the machine does not have the three linear axes, has another axis that moves, or does
/// not state the ranges of the axes.
ThreeAxes three_axes(const model::Machine& machine);

/// Returns the states of the machine at commands of X, Y and Z (one column for each command, mm). `at` (one
/// state): all other values of the states.
model::States states_at(const ThreeAxes& axes, const Eigen::Matrix3Xd& commands, const model::States& at);

/// Returns the rms length of error vectors, um. `error`: one column for each vector, mm.
double rms_um(const Eigen::Matrix3Xd& error);

}  // namespace vernier::exchange
