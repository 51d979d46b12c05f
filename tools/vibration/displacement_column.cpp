// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/vibration/displacement_column.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "comp/vibration/displacement.h"
#include "tools/format/units.h"
#include "tools/text/error.h"
#include "tools/vibration/integration.h"

namespace vernier::vibration {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();  // an empty cell
// Of the corner: a filter of second order forgets 99.9 % in three periods. Six periods remain for
// reading.
constexpr double kSettlingPeriods = 3, kFewestPeriods = 6;
constexpr double kLedShare = 0.1;  // of the record, at either end
// Number of tested corners, and steps of a line between two of them.
constexpr std::size_t kCorners = 60, kLineSteps = 200;

/// mm/s^2 in the signal's unit.
double acceleration_factor(const Signal& signal) {
  const auto unit = format::find_unit(signal.unit);
  if (!unit || unit->dimension != format::Dimension::kAcceleration)
    throw text::InputError(
        fmt::format("\"{}\": the signal is no acceleration (unit g, m/s^2 or mm/s^2), so the displacement "
                    "cannot be computed: \"{}\"",
                    signal.name, signal.unit));
  return unit->factor;
}

std::vector<double> in_mm_s2(const Signal& signal) {
  const double factor = acceleration_factor(signal);
  std::vector<double> x = signal.value;
  for (double& value : x) value *= factor;
  return x;
}

/// Returns the acceleration without its mean, tapered over a tenth of the record at either end
/// (half a cosine). The spectral lines assume a record that repeats itself, so its ends must not
/// jump. mm/s^2.
std::vector<double> led_in_and_out(const Signal& signal) {
  std::vector<double> x = in_mm_s2(signal);
  const auto n = static_cast<double>(x.size());
  const auto weight = [n](std::size_t i) {
    const double to_end = std::min(static_cast<double>(i) + 0.5, n - static_cast<double>(i) - 0.5);
    return 0.5 - 0.5 * std::cos(std::numbers::pi * std::min(1.0, to_end / (kLedShare * n)));
  };
  double sum = 0, weights = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += weight(i) * x[i], weights += weight(i);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = weight(i) * (x[i] - sum / weights);
  return x;
}

/// The board's filter, from its first sample on.
DisplacementSeries by_corner(const Signal& signal, double rate_Hz, double corner_Hz, double resolution) {
  const DisplacementScale scale{std::llround(1e6 * resolution * acceleration_factor(signal)),
                                std::llround(1e3 * rate_Hz), std::llround(1e3 * corner_Hz),
                                std::llround(180 * rate_Hz)};  // 0.18 of the rate, as on the board
  Displacement filter;
  if (!filter.start(scale))
    throw text::InputError(
        fmt::format("--corner {:g} Hz: at a sample rate of {:g} Hz the corner must be from {:.3g} to {:.4g} "
                    "Hz, and the resolution of \"{}\" must be such that a sample is at most 16 um",
                    corner_Hz, rate_Hz, std::max(0.001, rate_Hz / 131072), rate_Hz / 64, signal.name));
  DisplacementSeries series{signal.name, {}, corner_Hz, 0, 0};
  const double settled = kSettlingPeriods * rate_Hz / corner_Hz;
  for (std::size_t i = 0; i < signal.value.size(); ++i) {
    const double lsb = std::clamp(std::round(signal.value[i] / resolution), -1e9, 1e9);
    const double um = 1e-3 * filter.step(static_cast<std::int32_t>(lsb)).count;
    series.um.push_back(static_cast<double>(i) + 1 < settled ? kNoValue : um);
  }
  series.held = filter.held();
  return series;
}

DisplacementSeries by_power(const Signal& signal, double rate_Hz, std::optional<double> cutoff) {
  const std::vector<double> x = led_in_and_out(signal);
  DisplacementSeries series{signal.name, {}, cutoff ? *cutoff : noise_floor_cutoff(x), 0, 0};
  SpectralCut cut;
  series.um = integrate_lines(x, rate_Hz, series.cut, &cut);
  series.kept = cut.kept;
  const auto led = static_cast<std::size_t>(std::ceil(kLedShare * static_cast<double>(x.size())));
  for (std::size_t i = 0; i < x.size(); ++i)
    series.um[i] = i < led || i + led >= x.size() ? kNoValue : 1e3 * series.um[i];
  return series;
}

/// A signal and its measured values, by rows that have both.
struct Pairing {
  const Signal* signal = nullptr;
  std::vector<std::size_t> sample;
  std::vector<double> um;
};

std::vector<Pairing> pairings_of(const VibrationRecord& record, const std::vector<KnownDisplacement>& known,
                                 const std::vector<std::optional<std::size_t>>& ends) {
  std::vector<Pairing> pairings;
  for (const KnownDisplacement& one : known) {
    Pairing pairing;
    for (const Signal& signal : record.signals)
      if (signal.name == one.signal) pairing.signal = &signal;
    if (pairing.signal == nullptr)
      throw text::InputError(
          fmt::format("\"{}\": the accelerometer record has no signal of this name", one.signal));
    for (std::size_t row = 0; row < ends.size(); ++row) {
      if (!ends[row] || *ends[row] >= record.samples || !std::isfinite(one.at_row_um[row])) continue;
      pairing.sample.push_back(*ends[row]);
      pairing.um.push_back(one.at_row_um[row]);
    }
    if (pairing.um.size() < 3)
      throw text::InputError(fmt::format(
          "\"{}\": only {} rows within the record have a measured displacement; at least three are required",
          one.signal, pairing.um.size()));
    pairings.push_back(std::move(pairing));
  }
  return pairings;
}

/// Sum of squares about the mean, and the count. Values that are not finite are excluded.
struct Spread {
  double squares = 0;
  std::size_t count = 0;
};

Spread spread_about_mean(const std::vector<double>& values) {
  double sum = 0;
  Spread spread;
  for (const double value : values)
    if (std::isfinite(value)) sum += value, ++spread.count;
  const double mean = sum / static_cast<double>(std::max<std::size_t>(spread.count, 1));
  for (const double value : values)
    if (std::isfinite(value)) spread.squares += (value - mean) * (value - mean);
  return spread;
}

/// Returns the rms of measured minus computed. Infinite if less than half of the rows have a
/// filter at its final value: a corner must not be selected because it has few rows.
double disagreement_um(const std::vector<Pairing>& pairings, double rate_Hz,
                       const DisplacementChoice& choice) {
  Spread all;
  std::size_t rows = 0;
  for (const Pairing& pairing : pairings) {
    const DisplacementSeries series = displacement_of(*pairing.signal, rate_Hz, choice);
    std::vector<double> rest;
    for (std::size_t i = 0; i < pairing.um.size(); ++i)
      rest.push_back(pairing.um[i] - series.um[pairing.sample[i]]);
    const Spread spread = spread_about_mean(rest);
    all.squares += spread.squares, all.count += spread.count, rows += rest.size();
  }
  if (2 * all.count < rows) return HUGE_VAL;
  return std::sqrt(all.squares / static_cast<double>(all.count));
}

/// Corners in Hz, or powers between the lines of all paired signals.
std::vector<double> offered_cuts(const VibrationRecord& record, const std::vector<Pairing>& pairings,
                                 Cut cut) {
  std::vector<double> offered;
  if (cut == Cut::kCorner) {
    const double length_s = static_cast<double>(record.samples) / record.rate_Hz;
    const double least = std::max({kFewestPeriods / length_s, record.rate_Hz / 131000, 0.001});
    const double ratio = record.rate_Hz / 64.1 / least;
    for (std::size_t i = 0; ratio >= 1 && i < kCorners; ++i)
      offered.push_back(least * std::pow(ratio, static_cast<double>(i) / static_cast<double>(kCorners - 1)));
    return offered;
  }
  std::vector<double> powers;
  for (const Pairing& pairing : pairings) {
    const std::vector<double> more = line_powers(led_in_and_out(*pairing.signal));
    powers.insert(powers.end(), more.begin(), more.end());
  }
  return cuts_between_lines(std::move(powers), kLineSteps);
}

}  // namespace

bool is_acceleration(const Signal& signal) {
  const auto unit = format::find_unit(signal.unit);
  return unit && unit->dimension == format::Dimension::kAcceleration;
}

DisplacementSeries displacement_of(const Signal& signal, double rate_Hz, const DisplacementChoice& choice) {
  return choice.cut == Cut::kCorner ? by_corner(signal, rate_Hz, choice.value.value_or(0), choice.resolution)
                                    : by_power(signal, rate_Hz, choice.value);
}

AgreedCut agreed_cut(const VibrationRecord& record, const std::vector<KnownDisplacement>& known,
                     const std::vector<std::optional<std::size_t>>& ends, const DisplacementChoice& choice) {
  const std::vector<Pairing> pairings = pairings_of(record, known, ends);
  AgreedCut best{0, HUGE_VAL, 0};
  DisplacementChoice one = choice;
  for (const double offered : offered_cuts(record, pairings, choice.cut)) {
    one.value = choice.cut == Cut::kCorner ? std::round(1e3 * offered) * 1e-3 : offered;  // whole mHz
    const double rms_um = disagreement_um(pairings, record.rate_Hz, one);
    if (rms_um < best.rms_um) best = {*one.value, rms_um, 0};
  }
  if (!std::isfinite(best.rms_um))
    throw text::InputError(
        "the record is too short to find a cut-off frequency: it is shorter than six periods of every tested "
        "frequency");
  Spread measured;
  for (const Pairing& pairing : pairings) {
    const Spread spread = spread_about_mean(pairing.um);
    measured.squares += spread.squares, measured.count += spread.count;
  }
  best.measured_rms_um = std::sqrt(measured.squares / static_cast<double>(measured.count));
  return best;
}

}  // namespace vernier::vibration
