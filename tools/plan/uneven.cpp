// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/uneven.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "tools/maths/rounding.h"
#include "tools/text/numbers.h"

namespace vernier::plan {
namespace {

using Wave = std::complex<double>;

constexpr double kMostPeriods = 1000;  // as a diagnosis looks for (FinePeriodExtent::most_periods)
constexpr std::size_t kPerRange = 2;   // frequencies evaluated for each that the range can distinguish
constexpr std::size_t kFrequencies = static_cast<std::size_t>(kMostPeriods) * kPerRange;  // looked at in all

/// sum over the positions of exp(2 pi i f q) at f = k / (kPerRange * span), k = 0 ...
std::vector<Wave> window(const std::vector<double>& positions, double low, double span) {
  std::vector<Wave> sum(kFrequencies, 0);
  for (const double q : positions) {
    const Wave turn = std::polar(1.0, 2 * std::numbers::pi * (q - low) / span / kPerRange);
    Wave now = 1;
    for (Wave& at : sum) {
      at += now;
      now *= turn;
    }
  }
  return sum;
}

}  // namespace

std::vector<double> uneven_positions(double low, double high, const std::vector<double>& taken,
                                     std::size_t count) {
  constexpr int kDraws = 60;                     // sets of positions, of which the best is used
  constexpr std::size_t kFirst = 3 * kPerRange;  // below, waves differ by less than three over the range
  const double span = high - low;
  std::vector<double> distinct = taken;
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  const std::vector<Wave> there = window(distinct, low, span);
  // To a ten-thousandth of the range or so, so that they can be read and typed.
  const double digit = maths::decade(span / 5000);
  std::mt19937_64 random(1);
  std::vector<double> best;
  double least = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<double> positions(count);
    for (std::size_t i = 0; i < count; ++i) {
      // One in each stretch, anywhere in it.
      const double share = (static_cast<double>(i) + static_cast<double>(random() >> 11) * 0x1p-53) /
                           static_cast<double>(count);
      positions[i] = maths::rounded_to(low + share * span, digit);
    }
    const std::vector<Wave> more = window(positions, low, span);
    double highest = 0;
    for (std::size_t k = kFirst; k < kFrequencies; ++k)
      highest = std::max(highest, std::abs(there[k] + more[k]));
    if (!best.empty() && highest >= least) continue;
    least = highest;
    best = positions;
  }
  return best;
}

std::string uneven_sentence(const model::Machine& machine, const model::Measurement& measurement,
                            const diagnose::CandidateFinding& finding) {
  constexpr std::size_t kPositions = 12;  // recommended number: two for each of six periods
  const std::size_t axis = finding.axis.value();
  const model::Column at = model::commanded(measurement, axis);
  std::vector<double> taken;
  for (std::size_t row = 0; row < measurement.rows(); ++row)
    if (measurement.check[row] == 0) taken.push_back(at[static_cast<Eigen::Index>(row)]);
  const auto [low, high] = std::minmax_element(taken.begin(), taken.end());
  std::string text;
  for (const double q : uneven_positions(*low, *high, taken, kPositions))
    text += (text.empty() ? "" : ", ") + text::number_text(q);
  const model::Axis& item = machine.axes[axis];
  return fmt::format(
      "Measure also at these uneven positions of the axis {}, to distinguish the {} periods: {}{}", item.name,
      finding.aliases.size() + 1, text, item.rotary ? " deg, both directions." : " mm, both directions.");
}

}  // namespace vernier::plan
