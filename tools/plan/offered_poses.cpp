// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/offered_poses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tools/format/columns.h"
#include "tools/maths/halton.h"
#include "tools/maths/rounding.h"
#include "tools/model/chain/work_poses.h"
#include "tools/text/error.h"

namespace vernier::plan {

using Eigen::Index;

model::States offered_poses(const model::Machine& machine, std::size_t count, std::size_t from) {
  constexpr std::size_t kPrimes[] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29};
  model::States states = model::make_states(count, machine);
  for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) {
    const auto range = model::work_range(machine, axis);
    if (!range)
      throw text::InputError({machine.file, machine.axes[axis].line}, machine.axes[axis].name,
                             "the plan needs min and max of this axis in the machine file");
    for (std::size_t i = 0; i < count; ++i) {
      double share = maths::radical_inverse(from + i + 1, kPrimes[axis % std::size(kPrimes)]);
      // A third of the poses are at the ends of an axis, taken from another sequence.
      const double end = maths::radical_inverse(from + i + 1, kPrimes[(axis + 4) % std::size(kPrimes)]);
      if (end < 1.0 / 6) share = 0;
      if (end > 5.0 / 6) share = 1;
      const double value = (*range)[0] + share * ((*range)[1] - (*range)[0]);
      const double digit = maths::decade(((*range)[1] - (*range)[0]) / 500);
      states.axis[axis][static_cast<Index>(i)] =
          std::clamp(maths::rounded_to(value, digit), (*range)[0], (*range)[1]);
      states.direction[axis][static_cast<Index>(i)] =
          maths::radical_inverse(from + i + 1, kPrimes[(axis + 2) % std::size(kPrimes)]) < 0.5 ? -1 : 1;
    }
  }
  return states;
}

std::vector<std::size_t> nearest_way(const model::Machine& machine, const model::States& offered,
                                     const std::vector<std::size_t>& chosen) {
  std::vector<std::size_t> rest = chosen, way;
  const auto far = [&](std::size_t a, std::size_t b) {
    double squares = 0;
    for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) {
      const auto range = model::work_range(machine, axis);
      const double step =
          (offered.axis[axis][static_cast<Index>(a)] - offered.axis[axis][static_cast<Index>(b)]) /
          std::max((*range)[1] - (*range)[0], 1e-9);
      squares += step * step;
    }
    return squares;
  };
  while (!rest.empty()) {
    const auto next = way.empty()
                          ? rest.begin()
                          : std::min_element(rest.begin(), rest.end(), [&](std::size_t a, std::size_t b) {
                              return far(way.back(), a) < far(way.back(), b);
                            });
    way.push_back(*next);
    rest.erase(next);
  }
  return way;
}

std::string input_headings(const model::Machine& machine) {
  std::string text;
  for (const model::Input& input : machine.inputs)
    text += input.unit.empty() ? input.name + "," : fmt::format("{}[{}],", input.name, input.unit);
  return text;
}

std::string input_references(const model::Machine& machine) {
  std::string text;
  for (const model::Input& input : machine.inputs) text += fmt::format("{:g},", input.reference);
  return text;
}

std::string pose_rows_csv(const model::Machine& machine, const model::States& states,
                          const std::vector<char>& check, double reading_um, const std::string& run) {
  std::string text;
  for (const model::Axis& axis : machine.axes)
    for (const auto quantity : {format::AxisQuantity::kPosition, format::AxisQuantity::kSense})
      text += format::axis_heading(quantity, axis.name, axis.rotary) + ",";
  text += input_headings(machine);
  namespace columns = format::columns;
  text += format::headings(columns::kPoint) + "," +
          format::headings(std::array{columns::kUncertainty, columns::kRun, columns::kRole}) + "\n";
  for (std::size_t row = 0; row < states.count; ++row) {
    const auto at = static_cast<Index>(row);
    for (std::size_t i = 0; i < machine.axes.size(); ++i)
      text += fmt::format("{:.6g},{:g},", states.axis[i][at], states.direction[i][at]);
    text += input_references(machine);
    text += fmt::format(",,,{:g},{},{}\n", 1e-3 * reading_um, run, check[row] != 0 ? "check" : "fit");
  }
  return text;
}

}  // namespace vernier::plan
