// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::residual {

struct ConfidenceInterval {
  double low = 0, high = 0;
};

/// Statistics of the errors in a group of readings, um; urad for rotations. The intervals are 95 % confidence
/// intervals. The largest error has no interval, because resampling cannot estimate such an interval (Efron
/// and Tibshirani, An Introduction to the Bootstrap, 1993, section 7.4).
struct ErrorFigures {
  std::size_t count = 0;
  double mean = 0, spread = 0, rms = 0, largest = 0;
  std::optional<ConfidenceInterval> mean_interval, spread_interval, rms_interval;
};

/// Errors without and with the correction, for all length readings or for a part of them.
struct ReductionGroup {
  std::optional<model::ObservationKind>
      kind;                    // readings of only this kind (rotations are only in groups of their own kind)
  std::optional<double> feed;  // readings at only this feed, mm/min
  ErrorFigures before, after;
  /// The reduction is 1 - rms after / rms before, with its 95 % confidence interval. The reduction has no
  /// value if there are too few readings or if all readings are 0.
  std::optional<double> reduction;
  std::optional<ConfidenceInterval> interval;
};

enum class Helped : std::uint8_t { kHelped, kMadeWorse, kCannotBeTold };

struct BeforeAfter {
  bool paired = false;      // true: only poses that both files have are compared, one by one
  std::size_t samples = 0;  // number of poses that were resampled; if not paired, number of blocks of rows in
                            // both files
  std::size_t unmatched_before = 0, unmatched_after = 0;  // excluded rows at poses that the other file does
                                                          // not have
  std::size_t corrected_before = 0, corrected_after = 0;  // rows with a correction that is not 0
  ReductionGroup all;
  std::vector<ReductionGroup> groups;  // groups by kind, by feed, and by both
  Helped verdict() const;
};

struct BeforeAfterOptions {
  std::uint64_t seed = 1;        // seed of the random numbers for resampling
  std::size_t resamples = 2000;  // with this number of resamples, the error of the interval ends is a few per
                                 // cent of the interval's length
};

/// Tests whether the correction reduced the errors of the machine. The error of a reading is the reading
/// minus the prediction of the nominal chain at the commanded position. Each measurement file has its
/// best-fit set-up (BaseShift, if the BaseShift is free in the machine). The roles fit and check of the rows
/// are ignored.
///
/// If at least half of the rows in both files are at common poses (axes, approach direction, feed, point),
/// whole poses are resampled, for both files together. If fewer rows are at common poses, blocks of
/// neighbouring rows in each file are resampled. The interval of the reduction is computed from the logarithm
/// of the ratio, studentised with its linearised standard uncertainty (bootstrap-t: Efron and Tibshirani,
/// section 12.5). Throws InputError if a file has no length reading.
BeforeAfter compare_before_after(const model::Machine& machine, const model::Measurement& before,
                                 const model::Measurement& after, const BeforeAfterOptions& options = {});

/// Returns the error of every reading relative to the nominal chain at the commanded position, mm or deg.
Eigen::VectorXd errors_as_commanded(const model::Machine& machine, const model::Measurement& measurement);

}  // namespace vernier::residual
