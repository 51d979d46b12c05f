// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/vibration/feature_rows.h"

namespace vernier::vibration {

/// Name of the displacement in the list of the features of a signal.
inline constexpr const char* kDisplacementName = "DISPLACEMENT";

/// Method that removes low frequencies from a displacement: a cut-off frequency (the board's filter), or a
/// least power of spectral lines.
enum class Cut {
  kCorner,  // cut-off frequency in Hz of the filter comp/vibration/displacement.h; gives the displacement
            // that the board has at that moment
  kPower,   // least power |F|^2/N of a kept spectral line, (mm/s^2)^2; needs the whole record
};

/// Settings for the displacement that is computed from an acceleration record.
struct DisplacementChoice {
  Cut cut = Cut::kPower;
  std::optional<double> value;  // cut-off value; without a value, the noise floor of each signal is used
                                // (only kPower)
  double resolution = 1e-5;     // resolution of a sample in the unit of its signal (only kCorner), as on the
                                // board
};

/// Displacement of one acceleration signal at each of its samples, um. With kCorner, the displacement is NaN
/// during the first three periods of the cut-off frequency, in which the board's filter settles. With kPower,
/// the displacement is NaN in the first and last tenth of the record, which are tapered.
struct DisplacementSeries {
  std::string name;
  std::vector<double> um;
  double cut = 0;          // cut-off that was used, Hz or (mm/s^2)^2
  std::size_t kept = 0;    // number of kept spectral lines (kPower)
  std::uint32_t held = 0;  // number of samples outside the range of the board's filter (kCorner)
};

/// Returns true if the signal is an acceleration (unit g, m/s^2 or mm/s^2).
bool is_acceleration(const Signal& signal);

/// Computes the displacement from an acceleration signal. Throws InputError if the unit is not that of an
/// acceleration, or if comp/vibration/displacement.h does not accept the cut-off frequency or the resolution.
DisplacementSeries displacement_of(const Signal& signal, double rate_Hz, const DisplacementChoice& choice);

/// A signal whose displacement another instrument has measured at some of its samples, um; NaN: not measured.
struct KnownDisplacement {
  std::string signal;
  std::vector<double> at_row_um;
};

/// Finds the cut-off value with the least rms difference between computed and measured displacements over all
/// signals. The mean difference of each signal is removed first. kCorner: the function tests 60 cut-off
/// frequencies with equal ratios, from the lowest that the length of the record permits (six periods) to
/// rate/64. kPower: the function tests up to 200 numbers of kept spectral lines, in equal steps of their
/// logarithm. Throws InputError if a signal has fewer than three rows with a measured displacement, or if the
/// record is too short for all tested cut-off frequencies.
struct AgreedCut {
  double value = 0, rms_um = 0;  // best cut-off value, and rms of the remaining difference
  double measured_rms_um =
      0;  // rms of the measured displacements about their mean: the difference if no displacement is computed
};
AgreedCut agreed_cut(const VibrationRecord& record, const std::vector<KnownDisplacement>& known,
                     const std::vector<std::optional<std::size_t>>& ends, const DisplacementChoice& choice);

}  // namespace vernier::vibration
