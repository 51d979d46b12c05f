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
  std::size_t kept = 0, lines = 0;  // numbers of kept lines and of all lines; the mean value is not a line
};

/// Choice of the two integration constants for velocity and displacement.
enum class Constants {
  kPublished,  // velocity and displacement are 0 at the first sample; their means are not removed
  kCentred,    // mean velocity and mean displacement of the record are 0
};

/// Returns the record without its mean and without the spectral lines whose |F|^2/N is at or below `cutoff`.
/// x: n >= 2 samples.
std::vector<double> kept_lines(std::span<const double> x, double cutoff, SpectralCut* cut = nullptr);

/// Integrates an acceleration twice by the trapezoidal rule and returns the displacement (equations 4-1,
/// 4-2). x is in unit/s^2, the result in the same unit without /s^2.
std::vector<double> integrate_twice(std::span<const double> x, double rate_Hz, Constants constants);

/// Returns the power |F|^2/N of each spectral line except the mean value, lowest frequency first.
std::vector<double> line_powers(std::span<const double> x);

/// Computes the displacement from the spectral lines of an acceleration above `cutoff`: each line is divided
/// by -(2 pi f)^2. The trapezoidal rule of integrate_twice with Constants::kCentred approximates
/// integrate_lines. The trapezoidal rule gives a displacement that is too small near half of the sample rate
/// (25 % at 200 Hz for a rate of 1 kHz). integrate_twice and integrate_lines assume that the record is
/// periodic. x is in unit/s^2, the result in the same unit without /s^2.
std::vector<double> integrate_lines(std::span<const double> x, double rate_Hz, double cutoff,
                                    SpectralCut* cut = nullptr);

/// Returns at most `steps` cut-off values, each between the powers of two spectral lines. The cut-off values
/// keep from one line to all lines except one, in equal steps of the logarithm of the number of lines.
std::vector<double> cuts_between_lines(std::vector<double> powers, std::size_t steps);

/// Returns the cut-off power that white noise exceeds on average once in `records` records. The cut-off power
/// is the median of the line powers divided by ln 2, multiplied by ln(lines * records), because the power of
/// a noise line has an exponential distribution. The estimate of the noise is valid if at most half of the
/// spectral lines contain a signal.
double noise_floor_cutoff(std::span<const double> x, double records = 20);

/// One pass of a ball bar test with an accelerometer at the tool. A pass has accelerations in mm/s^2, the
/// angle of the commanded position at each sample in rad, and the mean deviation of the ball bar in um.
struct AcceleratedPass {
  std::vector<double> ax, ay, angle_rad;
  double rate_Hz = 0;
  double mean_ballbar_um = 0;
};

/// Returns the radial displacement of a pass as the mean over the record, um. The radial displacement is
/// computed from the spectral lines of both axes above the cut-off power.
double mean_radial_um(const AcceleratedPass& pass, double cutoff, Constants constants);

/// Finds the cut-off power that minimises the objective of equation 4-1: the sum over all passes (clockwise,
/// counter-clockwise) of |mean(ball bar) - mean(accelerometer)|. The value of the objective changes only
/// where a spectral line is removed. The search therefore tests at most `steps` cut-off values between the
/// powers of the spectral lines of all passes. The result is the best cut-off power and its objective (um).
/// Throws InputError if there is no pass, if a pass has fewer than four samples, or if the series of a pass
/// have different lengths.
struct FittedCut {
  double cutoff = 0, objective_um = 0;
};
FittedCut fitted_cutoff(const std::vector<AcceleratedPass>& passes, Constants constants,
                        std::size_t steps = 200);

}  // namespace vernier::vibration
