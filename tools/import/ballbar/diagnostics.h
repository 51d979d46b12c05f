// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace vernier::importer {

inline constexpr std::size_t kDiagnosticsCount = 20;  // number of linear diagnostics

/// Names of the linear diagnostics as they are in the file of the instrument (without AF_), in the order of
/// the basis functions.
inline constexpr std::array<const char*, kDiagnosticsCount> kDiagnosticsNames = {"GLOBAL_SCALE",
                                                                                 "CENTRE_OFFSET_A",
                                                                                 "CENTRE_OFFSET_B",
                                                                                 "SCALE_MISMATCH",
                                                                                 "SQUARENESS",
                                                                                 "STRAIGHTNESS_A",
                                                                                 "STRAIGHTNESS_B",
                                                                                 "SERVO_MISMATCH",
                                                                                 "SIN_4_THETA",
                                                                                 "RADIUS_CHANGE",
                                                                                 "OFFSET_A_SHIFT",
                                                                                 "OFFSET_B_SHIFT",
                                                                                 "BACKLASH_A_GLOBAL",
                                                                                 "BACKLASH_A_MISMATCH",
                                                                                 "BACKLASH_B_GLOBAL",
                                                                                 "BACKLASH_B_MISMATCH",
                                                                                 "LATERAL_PLAY_A_GLOBAL",
                                                                                 "LATERAL_PLAY_A_MISMATCH",
                                                                                 "LATERAL_PLAY_B_GLOBAL",
                                                                                 "LATERAL_PLAY_B_MISMATCH"};
/// Units of the linear diagnostics: um, except um/m for the squareness and ms for the servo mismatch.
inline constexpr std::array<const char*, kDiagnosticsCount> kDiagnosticsUnits = {
    "um", "um", "um", "um", "um/m", "um", "um", "ms", "um", "um",
    "um", "um", "um", "um", "um",   "um", "um", "um", "um", "um"};

/// One sample of a circular test.
struct DiagnosticsSample {
  double angle_deg = 0;     // angle from +A towards +B
  int direction = +1;       // +1 counter-clockwise, -1 clockwise
  double deviation_um = 0;  // measured radius - nominal radius
};

struct DiagnosticsSetup {
  double radius_mm = 100;
  double feed_mm_min = 1000;  // feed; it affects only the scale of the servo mismatch
  double reversal_gap_deg =
      12;  // samples nearer than this angle to 0/90/180/270 deg are excluded (reversal spikes)
  double pitch_a_mm = 0, pitch_b_mm = 0;  // periods of the cyclic errors that are fitted too; 0: not fitted
};

/// Returns the radial deviation per unit of each diagnostic, um, at the given angle and direction. The basis
/// functions were found by recomputing the simulation that a file contains (tests/data/ballbar/README.md).
std::array<double, kDiagnosticsCount> diagnostics_basis(double angle_deg, int direction,
                                                        const DiagnosticsSetup& setup);

/// Peak-to-peak amplitude of a cyclic error of one axis, for one direction of the axis and one direction of
/// the circle.
struct CyclicAmplitude {
  char axis = 'A';
  bool forward = true;  // true: the axis moves in its positive direction
  int direction = +1;
  double peak_to_peak_um = 0;
};

/// Effect of the cyclic terms of one axis on the radius in one direction of the circle: largest minus
/// smallest.
struct CyclicEffect {
  char axis = 'A';
  int direction = +1;
  double um = 0;
};

struct DiagnosticsResult {
  std::array<double, kDiagnosticsCount> value{};
  std::vector<CyclicAmplitude> cyclic;
  std::vector<CyclicEffect> cyclic_effect;
  std::size_t samples = 0, rank = 0, columns = 0;  // rank < columns: the data cannot separate the terms
  double rms_um = 0, max_um = 0;                   // rms and maximum of the residual
};

/// Fits the linear diagnostics (and the cyclic terms) by least squares to samples of both directions. If the
/// rank is deficient, the result is the minimum-norm solution. Throws std::invalid_argument if there are
/// fewer samples than terms to fit.
DiagnosticsResult fit_diagnostics(const std::vector<DiagnosticsSample>& samples,
                                  const DiagnosticsSetup& setup);

}  // namespace vernier::importer
