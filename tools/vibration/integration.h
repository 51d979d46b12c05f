// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace vernier::vibration {

/// Spectral lines of a record that are kept: |F|^2/N above a cut-off, in the squared unit of the
/// samples (C. Walker, PhD thesis, University of Strathclyde 2026, section 4; `facts.json`
/// fft_filter).
struct SpectralCut {
  double cutoff = 0;
  std::size_t kept = 0, lines = 0;  // without the mean value
};

/// Choice of the two constants of integration.
enum class Constants {
  kPublished,  // velocity and displacement start at 0; their means are not removed
  kCentred,    // mean velocity and mean displacement of the record are 0
};

/// Returns the record without the lines at or below `cutoff`, and without its mean. x: n >= 2
/// samples.
std::vector<double> kept_lines(std::span<const double> x, double cutoff, SpectralCut* cut = nullptr);

/// Returns displacement from acceleration by cumulative trapezoids, twice (equations 4-1, 4-2). x
/// in unit/s^2; result in that unit.
std::vector<double> integrate_twice(std::span<const double> x, double rate_Hz, Constants constants);

/// Returns |F|^2/N of the lines above the mean value, lowest frequency first.
std::vector<double> line_powers(std::span<const double> x);

/// Returns displacement from the lines above `cutoff`, each divided by -(2 pi f)^2. The trapezoids of
/// integrate_twice with Constants::kCentred are an approximation of integrate_lines, with a loss towards half
/// the rate (25 % at 200 Hz of 1 kHz). Both functions assume a periodic record. x in unit/s^2; result in that
/// unit.
std::vector<double> integrate_lines(std::span<const double> x, double rate_Hz, double cutoff,
                                    SpectralCut* cut = nullptr);

/// Returns cut-offs between lines of these powers, at most `steps`. The cut-offs select from 1 line to all
/// lines except one, evenly in the logarithm of the number of lines.
std::vector<double> cuts_between_lines(std::vector<double> powers, std::size_t steps);

/// Returns the cut-off that lines of white noise alone exceed once in `records` records. The floor
/// is the median line over ln 2 (lines of noise are exponentially distributed), times ln(lines *
/// records). The estimate requires that at most half of the lines contain signal.
double noise_floor_cutoff(std::span<const double> x, double records = 20);

/// One pass of a ball bar with an accelerometer at the tool: accelerations in mm/s^2, angle of the
/// commanded position of each sample in rad, and the mean of the ball bar's deviations, um.
struct AcceleratedPass {
  std::vector<double> ax, ay, angle_rad;
  double rate_Hz = 0;
  double mean_ballbar_um = 0;
};

/// Radial displacement of a pass, um, mean over the record. The result contains the lines of both axes above
/// the cut-off.
double mean_radial_um(const AcceleratedPass& pass, double cutoff, Constants constants);

/// Finds the cut-off that minimises the objective of equation 4-1: the sum over passes (clockwise,
/// counter-clockwise) of |mean(ball bar) - mean(accelerometer)|. The objective changes only if a
/// line is removed. The search therefore uses `steps` cut-offs between the lines of all passes in
/// order of power. Returns cut-off and objective (um). Throws InputError for records of unequal
/// length or no records.
struct FittedCut {
  double cutoff = 0, objective_um = 0;
};
FittedCut fitted_cutoff(const std::vector<AcceleratedPass>& passes, Constants constants,
                        std::size_t steps = 200);

}  // namespace vernier::vibration
