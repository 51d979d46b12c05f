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

/// Errors of a group of readings: um, urad for rotations. Intervals of 95 %. The largest error has
/// no interval, because resampling cannot estimate it (Efron and Tibshirani, An Introduction to
/// the Bootstrap, 1993, section 7.4).
struct ErrorFigures {
  std::size_t count = 0;
  double mean = 0, spread = 0, rms = 0, largest = 0;
  std::optional<ConfidenceInterval> mean_interval, spread_interval, rms_interval;
};

/// Errors before and after the correction, of all length readings or of a part of them.
struct ReductionGroup {
  std::optional<model::ObservationKind>
      kind;                    // of one kind only (rotations are only in groups of their own kind)
  std::optional<double> feed;  // of one feed only, mm/min
  ErrorFigures before, after;
  /// 1 - rms after / rms before, and its 95 % interval; nullopt if there are too few readings, or all
  /// readings are 0.
  std::optional<double> reduction;
  std::optional<ConfidenceInterval> interval;
};

enum class Helped : std::uint8_t { kHelped, kMadeWorse, kCannotBeTold };

struct BeforeAfter {
  bool paired = false;      // only poses that both files have, compared one by one
  std::size_t samples = 0;  // poses that were resampled; else blocks of rows of both
  std::size_t unmatched_before = 0, unmatched_after = 0;  // excluded rows, at poses that the other file lacks
  std::size_t corrected_before = 0, corrected_after = 0;  // rows with a correction that is not 0
  ReductionGroup all;
  std::vector<ReductionGroup> groups;  // by kind, by feed, by both
  Helped verdict() const;
};

struct BeforeAfterOptions {
  std::uint64_t seed = 1;        // of the resampling
  std::size_t resamples = 2000;  // the ends of an interval are then accurate to a few per cent of its length
};

/// Tests whether the correction reduced the errors. Error of a reading: the reading minus the prediction of
/// the nominal chain at the commanded position, in the best set-up of each file (BaseShift, if it is free in
/// the machine). The roles of the rows are ignored.
///
/// If at least half of the rows of both files are at common poses (axes, approach direction, feed, point),
/// whole poses are resampled, both files together. Otherwise blocks of neighbouring rows of each file are
/// resampled. The interval of the reduction is that of the logarithm of the ratio, studentised with the
/// linearised standard uncertainty (bootstrap-t: Efron and Tibshirani, section 12.5). Throws InputError if a
/// file has no length reading.
BeforeAfter compare_before_after(const model::Machine& machine, const model::Measurement& before,
                                 const model::Measurement& after, const BeforeAfterOptions& options = {});

/// Returns the error of every reading as above, mm or deg.
Eigen::VectorXd errors_as_commanded(const model::Machine& machine, const model::Measurement& measurement);

}  // namespace vernier::residual
