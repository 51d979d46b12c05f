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

/// How a displacement is cut off below: by the board's filter, or by the power of spectral lines.
enum class Cut {
  kCorner,  // comp/vibration/displacement.h, Hz: what a board has at that instant
  kPower,   // lines with |F|^2/N above it, (mm/s^2)^2: needs the whole record
};

/// What the displacement of a record is made with.
struct DisplacementChoice {
  Cut cut = Cut::kPower;
  std::optional<double> value;  // of the cut; nothing: the noise floor of each signal (kPower only)
  double resolution = 1e-5;     // of a sample in its signal's unit (kCorner), as on the board
};

/// Displacement of one signal at each of its samples, um; NaN where the board's filter has not settled (three
/// periods of the corner), or where the record is led in and out (a tenth at either end; kPower).
struct DisplacementSeries {
  std::string name;
  std::vector<double> um;
  double cut = 0;          // Hz or (mm/s^2)^2
  std::size_t kept = 0;    // spectral lines (kPower)
  std::uint32_t held = 0;  // samples beyond the range of the board's filter (kCorner)
};

/// Is the signal an acceleration (unit g, m/s^2, mm/s^2)? tool.
bool is_acceleration(const Signal& signal);

/// Displacement of an acceleration. Throws InputError for a signal of another unit, and for a corner or a
/// resolution that comp/vibration/displacement.h refuses. tool.
DisplacementSeries displacement_of(const Signal& signal, double rate_Hz, const DisplacementChoice& choice);

/// A signal whose displacement was measured at some of its samples by other means, um; NaN: not measured.
struct KnownDisplacement {
  std::string signal;
  std::vector<double> at_row_um;
};

/// The value of the cut at which displacements and measurements agree best: least rms of their difference,
/// the mean of each signal's difference taken off, over all signals together. kCorner: 60 corners, even in
/// their logarithm, from what the record is long enough for (six periods) to rate/64. kPower: as many lines
/// kept as 200 even steps of their logarithm give. Throws InputError where fewer than three rows of a signal
/// have both. tool.
struct AgreedCut {
  double value = 0, rms_um = 0;  // of the cut; of what then is left
  double measured_rms_um = 0;    // of the measurements about their mean: what no cut at all would leave
};
AgreedCut agreed_cut(const VibrationRecord& record, const std::vector<KnownDisplacement>& known,
                     const std::vector<std::optional<std::size_t>>& ends, const DisplacementChoice& choice);

}  // namespace vernier::vibration
