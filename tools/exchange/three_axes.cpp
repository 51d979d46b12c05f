// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/exchange/three_axes.h"

#include <cmath>

#include "tools/text/error.h"

namespace vernier::exchange {

ThreeAxes three_axes(const model::Machine& machine) {
  ThreeAxes axes;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto found = machine.find_axis(kLetters[i]);
    if (!found || machine.axes[*found].rotary)
      throw text::InputError({machine.file, 0}, kLetters[i],
                             "this format is for machines with three linear axes X, Y and Z");
    const auto range = model::work_range(machine, *found);
    if (!range)
      throw text::InputError(
          {machine.file, machine.axes[*found].line}, kLetters[i],
          "this axis has no min and max in the machine file; the exported table must have a range");
    axes.axis[i] = *found;
    axes.low[i] = (*range)[0];
    axes.high[i] = (*range)[1];
  }
  for (const model::Axis& axis : machine.axes)
    if (axis.rotary)
      throw text::InputError({machine.file, axis.line}, axis.name,
                             "this format has only the axes X, Y and Z, and no rotary axis");
  return axes;
}

model::States states_at(const ThreeAxes& axes, const Eigen::Matrix3Xd& commands, const model::States& at) {
  model::States states =
      model::select_states(at, std::vector<std::size_t>(static_cast<std::size_t>(commands.cols()), 0));
  for (std::size_t i = 0; i < 3; ++i)
    states.axis[axes.axis[i]] = commands.row(static_cast<Eigen::Index>(i)).transpose().array();
  return states;
}

double rms_um(const Eigen::Matrix3Xd& error) {
  return 1000 * std::sqrt(error.squaredNorm() / static_cast<double>(error.cols()));
}

}  // namespace vernier::exchange
