// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/vibration/integration.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <numeric>
#include <utility>

#include "tools/maths/median.h"
#include "tools/text/error.h"
#include "tools/vibration/fourier.h"

namespace vernier::vibration {
namespace {

std::vector<double> cumulated(std::span<const double> x, double step) {
  std::vector<double> sum(x.size(), 0);
  for (std::size_t i = 1; i < x.size(); ++i) sum[i] = sum[i - 1] + (x[i - 1] + x[i]) / 2 * step;
  return sum;
}

void centre(std::vector<double>& x) {
  const double mean = std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
  for (double& value : x) value -= mean;
}

void check(const AcceleratedPass& pass) {
  if (pass.ax.size() < 4 || pass.ay.size() != pass.ax.size() || pass.angle_rad.size() != pass.ax.size())
    throw text::InputError(
        "a circular pass needs accelerations of two axes and an angle for each of its samples");
}

/// Returns the spectrum of x with 0 for its mean and for lines at or below the cut-off.
std::vector<std::complex<double>> kept_spectrum(Fourier& fourier, std::span<const double> x, double cutoff,
                                                SpectralCut* cut) {
  const auto lines = fourier.forward(x);
  std::vector<std::complex<double>> kept(lines.begin(), lines.end());
  kept[0] = 0;
  std::size_t count = 0;
  for (std::size_t k = 1; k < kept.size(); ++k) {
    if (std::norm(kept[k]) / static_cast<double>(x.size()) > cutoff) {
      ++count;
    } else {
      kept[k] = 0;
    }
  }
  if (cut != nullptr) *cut = {cutoff, count, kept.size() - 1};
  return kept;
}

}  // namespace

std::vector<double> line_powers(std::span<const double> x) {
  Fourier fourier(x.size());
  const auto lines = fourier.forward(x);
  std::vector<double> powers;
  for (std::size_t k = 1; k < lines.size(); ++k)
    powers.push_back(std::norm(lines[k]) / static_cast<double>(x.size()));
  return powers;
}

std::vector<double> kept_lines(std::span<const double> x, double cutoff, SpectralCut* cut) {
  Fourier fourier(x.size());
  const auto series = fourier.backward(kept_spectrum(fourier, x, cutoff, cut));
  return {series.begin(), series.end()};
}

std::vector<double> integrate_lines(std::span<const double> x, double rate_Hz, double cutoff,
                                    SpectralCut* cut) {
  Fourier fourier(x.size());
  std::vector<std::complex<double>> lines = kept_spectrum(fourier, x, cutoff, cut);
  const double step_rad_s = 2 * std::numbers::pi * rate_Hz / static_cast<double>(x.size());
  for (std::size_t k = 1; k < lines.size(); ++k) {
    const double omega = step_rad_s * static_cast<double>(k);
    lines[k] /= -omega * omega;
  }
  const auto series = fourier.backward(lines);
  return {series.begin(), series.end()};
}

std::vector<double> cuts_between_lines(std::vector<double> powers, std::size_t steps) {
  std::sort(powers.begin(), powers.end(), std::greater<>());
  std::vector<double> cuts;
  std::size_t last = 0;
  for (std::size_t step = 0; powers.size() > 1 && step < steps; ++step) {
    const double share = static_cast<double>(step) / static_cast<double>(std::max<std::size_t>(steps - 1, 1));
    const auto kept = static_cast<std::size_t>(std::pow(static_cast<double>(powers.size() - 1), share));
    if (kept == last) continue;
    last = kept;
    cuts.push_back((powers[kept - 1] + powers[kept]) / 2);
  }
  return cuts;
}

std::vector<double> integrate_twice(std::span<const double> x, double rate_Hz, Constants constants) {
  std::vector<double> speed = cumulated(x, 1 / rate_Hz);
  if (constants == Constants::kCentred) centre(speed);
  std::vector<double> travel = cumulated(speed, 1 / rate_Hz);
  if (constants == Constants::kCentred) centre(travel);
  return travel;
}

double noise_floor_cutoff(std::span<const double> x, double records) {
  const std::vector<double> powers = line_powers(x);
  return maths::median(powers) / std::log(2.0) * std::log(static_cast<double>(powers.size()) * records);
}

double mean_radial_um(const AcceleratedPass& pass, double cutoff, Constants constants) {
  check(pass);
  const std::vector<double> x = integrate_twice(kept_lines(pass.ax, cutoff), pass.rate_Hz, constants);
  const std::vector<double> y = integrate_twice(kept_lines(pass.ay, cutoff), pass.rate_Hz, constants);
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    sum += x[i] * std::cos(pass.angle_rad[i]) + y[i] * std::sin(pass.angle_rad[i]);
  return sum / static_cast<double>(x.size()) * 1e3;
}

FittedCut fitted_cutoff(const std::vector<AcceleratedPass>& passes, Constants constants, std::size_t steps) {
  if (passes.empty())
    throw text::InputError("the cut-off frequency cannot be found, because there is no circular pass");
  std::vector<double> powers;
  for (const AcceleratedPass& pass : passes) {
    check(pass);
    for (const auto* axis : {&pass.ax, &pass.ay}) {
      const std::vector<double> more = line_powers(*axis);
      powers.insert(powers.end(), more.begin(), more.end());
    }
  }
  FittedCut best{0, HUGE_VAL};
  // Even steps of the logarithm of the number of kept lines: the strong lines decide.
  for (const double cutoff : cuts_between_lines(std::move(powers), steps)) {
    double objective = 0;
    for (const AcceleratedPass& pass : passes)
      objective += std::fabs(pass.mean_ballbar_um - mean_radial_um(pass, cutoff, constants));
    if (objective < best.objective_um) best = {cutoff, objective};
  }
  return best;
}

}  // namespace vernier::vibration
