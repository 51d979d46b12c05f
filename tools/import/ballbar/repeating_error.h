// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/import/ballbar/ballbar_file.h"

namespace vernier::importer {

/// A model of the error that repeats in every turn: centre, radius, and a table over the angle (periodic,
/// linear between stations). All rms values are in um.
struct RepeatingStep {
  std::size_t stations = 0;  // number of stations; 0: only centre and radius
  double left_out_um = 0;    // rms error of held-out samples of the turn: each fifth of the samples is
                             // predicted from the other samples
  double fit_um = 0;
  std::optional<double> other_turn_um, other_direction_um;  // rms error on the rest of the record, which
                                                            // neither the fit nor the selection used
  std::optional<double> other_turn_usual_um;  // typical error of the other turn, from the median of its
                                              // absolute errors, so that a few large errors have no influence
};

/// Models of the repeating error with increasing order. The models are fitted to the analysed turn of one run
/// and tested on the rest of the record.
struct RepeatingError {
  std::string run;
  std::size_t fit_samples = 0, other_turn_samples = 0, other_direction_samples = 0;
  std::vector<RepeatingStep> steps;
  std::size_t chosen = 0;  // index into `steps` of the model with the smallest left_out_um

  const RepeatingStep& best() const { return steps[chosen]; }
};

/// Fits models of the repeating error to the run with index `run` of a file, over its samples start..end.
/// `on_circle`: for each run and sample, whether the sample is used. If `on_circle` is empty, all samples are
/// used. The angle of a sample comes from the clock of the run, or from the file if the run has no clock.
RepeatingError repeating_error(const BallbarFile& file, std::size_t run,
                               const std::vector<std::vector<char>>& on_circle = {});

}  // namespace vernier::importer
