// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/import/ballbar/ballbar_file.h"

namespace vernier::importer {

/// A model of the repeating error of one turn: centre and radius, and a table of the angle (linear between
/// stations, periodic). rms in um.
struct RepeatingStep {
  std::size_t stations = 0;  // 0: centre and radius alone
  double left_out_um = 0;    // samples of the turn left out in fives, each fifth predicted from the rest
  double fit_um = 0;
  std::optional<double> other_turn_um, other_direction_um;  // held out: never seen by fit or choice
  std::optional<double> other_turn_usual_um;  // from the median size: independent of the few worst samples
};

/// Models of increasing order, fitted to the analysed turn of one run and tested on the rest of the record.
struct RepeatingError {
  std::string run;
  std::size_t fit_samples = 0, other_turn_samples = 0, other_direction_samples = 0;
  std::vector<RepeatingStep> steps;
  std::size_t chosen = 0;  // index into steps: least left_out_um

  const RepeatingStep& best() const { return steps[chosen]; }
};

/// Fits models of the repeating error to run `run` of a file, over its samples start..end. `on_circle` states
/// for each run and sample whether the sample is used (empty: all samples are used). The angle is that of the
/// clock of the run, else that of the file.
RepeatingError repeating_error(const BallbarFile& file, std::size_t run,
                               const std::vector<std::vector<char>>& on_circle = {});

}  // namespace vernier::importer
