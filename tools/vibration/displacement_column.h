// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/vibration/feature_rows.h"

namespace vernier::vibration {

/// Name of the displacement among the features of a signal.
inline constexpr const char* kDisplacementName = "DISPLACEMENT";

/// Method of the lower cut-off of a displacement: the board's filter, or the power of spectral
/// lines.
enum class Cut {
  kCorner,  // comp/vibration/displacement.h, Hz: the value on the board at that moment
  kPower,   // lines with |F|^2/N above it, (mm/s^2)^2: needs the whole record
};

/// Settings for the displacement of a record.
struct DisplacementChoice {
  Cut cut = Cut::kPower;
  std::optional<double> value;  // of the cut; no value: the noise floor of each signal (kPower only)
  double resolution = 1e-5;     // of a sample in its signal's unit (kCorner), as on the board
};

/// Displacement of one signal at each of its samples, um. The displacement is NaN where the board's filter
/// has not reached its final value (three periods of the corner), or in the tapered ends of the record (a
/// tenth at either end; kPower).
struct DisplacementSeries {
  std::string name;
  std::vector<double> um;
  double cut = 0;          // Hz or (mm/s^2)^2
  std::size_t kept = 0;    // spectral lines (kPower)
  std::uint32_t held = 0;  // samples beyond the range of the board's filter (kCorner)
};

/// True if the signal is an acceleration (unit g, m/s^2, mm/s^2).
bool is_acceleration(const Signal& signal);

/// Returns the displacement of an acceleration. Throws InputError for a signal of another unit,
/// and for a corner or a resolution that comp/vibration/displacement.h refuses.
DisplacementSeries displacement_of(const Signal& signal, double rate_Hz, const DisplacementChoice& choice);

/// A signal whose displacement is known from another measurement at some of its samples, um; NaN:
/// not measured.
struct KnownDisplacement {
  std::string signal;
  std::vector<double> at_row_um;
};

/// Finds the value of the cut at which displacements and measurements agree best: least rms of their
/// difference over all signals together, after removal of the mean difference of each signal. kCorner: 60
/// corners, even in their logarithm, from the lowest for the length of the record (six periods) to rate/64.
/// kPower: numbers of kept lines by 200 even steps of their logarithm. Throws InputError if fewer than three
/// rows of a signal have both displacement and measurement.
struct AgreedCut {
  double value = 0, rms_um = 0;  // of the cut; of the remaining difference
  double measured_rms_um =
      0;  // of the measurements about their mean: the difference without any displacement
};
AgreedCut agreed_cut(const VibrationRecord& record, const std::vector<KnownDisplacement>& known,
                     const std::vector<std::optional<std::size_t>>& ends, const DisplacementChoice& choice);

}  // namespace vernier::vibration
