// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/effects/survey/missing_directions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace vernier::effects {
namespace {

/// What a file shows of an axis.
struct AxisOfFile {
  bool has_direction = false, moves = false;
};

std::vector<AxisOfFile> files_of_axis(const model::Measurement& rows, std::size_t axis) {
  std::vector<AxisOfFile> files(rows.files.size());
  std::vector<double> first(rows.files.size());
  std::vector<char> begun(rows.files.size(), 0);
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    const auto at = static_cast<Eigen::Index>(row);
    const std::size_t file = rows.file[row];
    const double position = rows.states.axis[axis][at];
    if (begun[file] == 0) first[file] = position;
    begun[file] = 1;
    files[file].has_direction = files[file].has_direction || rows.states.direction[axis][at] != 0;
    files[file].moves = files[file].moves || position != first[file];
  }
  return files;
}

}  // namespace

std::vector<std::string> notes_of_missing_directions(const model::Machine& machine,
                                                     const model::Measurement& rows) {
  std::vector<std::vector<std::string>> missing(rows.files.size());
  for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) {
    const std::vector<AxisOfFile> files = files_of_axis(rows, axis);
    if (std::none_of(files.begin(), files.end(), [](const AxisOfFile& one) { return one.has_direction; }))
      continue;
    for (std::size_t file = 0; file < files.size(); ++file)
      if (files[file].moves && !files[file].has_direction)
        missing[file].push_back("dir" + machine.axes[axis].name);
  }
  std::vector<std::string> notes;
  for (std::size_t file = 0; file < missing.size(); ++file)
    if (!missing[file].empty())
      notes.push_back(fmt::format(
          "{} has no {}, and another file has. The model predicts no reversal error (backlash) for these "
          "rows, "
          "so that they contradict one. Add the approach direction of each row: 1 if the axis moved in the "
          "positive direction, -1 in the negative direction",
          rows.files[file], fmt::join(missing[file], ", ")));
  return notes;
}

}  // namespace vernier::effects
