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

/// Errors of some readings: um, urad for rotations. Intervals of 95 %; none of the largest, which no
/// resampling can judge (Efron and Tibshirani, An Introduction to the Bootstrap, 1993, section 7.4).
struct ErrorFigures {
  std::size_t count = 0;
  double mean = 0, spread = 0, rms = 0, largest = 0;
  std::optional<ConfidenceInterval> mean_interval, spread_interval, rms_interval;
};

/// Before and after, of all readings of lengths or of a part of them.
struct ReductionGroup {
  std::optional<model::ObservationKind> kind;  // of one kind only (rotations are in none of several)
  std::optional<double> feed;                  // of one feed only, mm/min
  ErrorFigures before, after;
  /// 1 - rms after / rms before, and its interval of 95 %; nothing where the readings are too few, or 0.
  std::optional<double> reduction;
  std::optional<ConfidenceInterval> interval;
};

enum class Helped : std::uint8_t { kHelped, kMadeWorse, kCannotBeTold };

struct BeforeAfter {
  bool paired = false;      // only poses that both have, compared one by one
  std::size_t samples = 0;  // poses that were resampled; else blocks of rows of both
  std::size_t unmatched_before = 0, unmatched_after = 0;  // rows left out, at poses that the other lacks
  std::size_t corrected_before = 0, corrected_after = 0;  // rows with a correction that is not 0
  ReductionGroup all;
  std::vector<ReductionGroup> groups;  // by kind, by feed, by both
  Helped verdict() const;
};

struct BeforeAfterOptions {
  std::uint64_t seed = 1;        // of the resampling
  std::size_t resamples = 2000;  // the ends of an interval are then good to a few per cent of its length
};

/// Did the correction help? Error of a reading: less what the nominal chain reads at the commanded position,
/// in the best set-up of each (BaseShift, where the machine leaves it free). Roles have no meaning here.
///
/// Where at least half of the rows of both stand at poses (axes, sense, feed, point) that both have, whole
/// poses are resampled, both sides together; else blocks of neighbouring rows of each side. The interval of
/// the reduction is that of the logarithm of the ratio, studentised with the linearised standard uncertainty
/// (bootstrap-t: Efron and Tibshirani, section 12.5). Throws InputError where one has no reading of a length.
/// tool.
BeforeAfter compare_before_after(const model::Machine& machine, const model::Measurement& before,
                                 const model::Measurement& after, const BeforeAfterOptions& options = {});

/// The error of every reading as above, mm or deg.
Eigen::VectorXd errors_as_commanded(const model::Machine& machine, const model::Measurement& measurement);

}  // namespace vernier::residual
