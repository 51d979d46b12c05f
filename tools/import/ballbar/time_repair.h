// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/import/ballbar/ballbar_file.h"
#include "tools/timebase/repeats.h"

namespace vernier::importer {

/// Samples that are missing before a sample of a record; the other pass, which has these samples, shows the
/// gap.
struct RecordGap {
  std::size_t sample = 0;               // 0-based index in the record
  double sample_uncertainty = 0;        // samples
  double missing = 0, uncertainty = 0;  // samples, standard uncertainty
};

/// Agreement of the second pass with the first pass at the same angle.
struct PassAgreement {
  double difference_um = 0;  // rms over what both passes have, mean and slope of each block taken off
  double level_um = 0;       // the same without a correction
  double correlation = 0;    // mean concordance of the blocks
  std::size_t samples = 0;
};

/// Changes by the repair of one run.
struct RunRepair {
  std::string label;
  bool repaired = false;
  std::string why_not;                     // reason if it is not repaired
  double turn_before = 0, turn_after = 0;  // samples of a whole turn
  double turn_uncertainty = 0;
  std::vector<RecordGap> gaps;
  double start_shift_deg = 0;  // by which the angle of the file's first analysed sample was changed
  std::optional<double> start_uncertainty_deg, start_correlation;  // if it was found from another run
  std::string start_from;                                          // label of that run; empty: kept
  std::size_t feed_in = 0, feed_out = 0;  // samples at the ends that are no part of the repeating motion
  PassAgreement before, after;
};

struct TimeRepair {
  BallbarFile file;  // with a clock in each repaired run; start..end: its first whole turn
  std::vector<RunRepair> runs;
};

/// Estimates from the record the number of samples per turn and the missing samples, and computes angle and
/// time of each sample. Method: the second pass over the circle repeats the first pass. If the lag between
/// the passes jumps, samples of one pass are missing, or the other pass had a pause; the function assumes
/// missing samples. The reference run is the run whose length of a turn agrees best with the file. In the
/// reference run the sample START (index from the file) keeps its angle. The angles of each other run are
/// shifted until its repeating error agrees with that of the reference run. A run of less than one and a half
/// turns, or a run that does not repeat, is not changed; its RunRepair contains the reason.
TimeRepair repair_time_base(const BallbarFile& file);

}  // namespace vernier::importer
