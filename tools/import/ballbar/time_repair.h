// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/import/ballbar/ballbar_file.h"
#include "tools/timebase/repeats.h"

namespace vernier::importer {

/// A gap: samples that are missing before a sample of a record. The comparison with the other pass, which has
/// these samples, shows the gap.
struct RecordGap {
  std::size_t sample = 0;               // index in the record, from 0, of the sample after the gap
  double sample_uncertainty = 0;        // standard uncertainty of this index, samples
  double missing = 0, uncertainty = 0;  // number of missing samples, and its standard uncertainty
};

/// Agreement of the second pass with the first pass at the same angle.
struct PassAgreement {
  double difference_um = 0;  // rms difference over the common samples of both passes, after removal of mean
                             // and slope of each block
  double level_um = 0;       // rms difference as above, but without a correction of the time base
  double correlation = 0;    // mean concordance correlation of the blocks
  std::size_t samples = 0;
};

/// Changes to the time base of one run by the repair.
struct RunRepair {
  std::string label;
  bool repaired = false;
  std::string why_not;                     // reason why the run was not repaired
  double turn_before = 0, turn_after = 0;  // number of samples in a whole turn, before and after the repair
  double turn_uncertainty = 0;
  std::vector<RecordGap> gaps;
  double start_shift_deg = 0;  // change of the angle of the first analysed sample in the file
  std::optional<double> start_uncertainty_deg, start_correlation;  // if the start angle was found from
                                                                   // another run
  std::string start_from;                                          // label of the run from which the start
                                                                   // angle was found; empty: the angle of the
                                                                   // file was kept
  std::size_t feed_in = 0, feed_out = 0;  // number of samples at the beginning and at the end that do not
                                          // belong to the repeated circular motion
  PassAgreement before, after;
};

struct TimeRepair {
  BallbarFile file;  // file with a clock in each repaired run; start..end is the first whole turn of the run
  std::vector<RunRepair> runs;
};

/// Estimates the number of samples per turn and the missing samples from the record of a run. From the number
/// of samples per turn and the missing samples, the function computes the angle and the time of each sample.
/// The method uses that the second pass over the circle repeats the first pass. If the lag between two passes
/// jumps, samples of one pass are missing, or the other pass had a pause. The function assumes missing
/// samples. The reference run is the run whose number of samples per turn agrees best with the file. In the
/// reference run the sample START (index from the file) keeps its angle. The angles of each other run are
/// shifted until its repeating error agrees with the repeating error of the reference run. A run is not
/// changed if it has less than one and a half turns or does not repeat. The RunRepair of a run that is not
/// changed contains the reason.
TimeRepair repair_time_base(const BallbarFile& file);

}  // namespace vernier::importer
