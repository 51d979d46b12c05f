// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/budget.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "tools/text/error.h"
#include "tools/text/numbers.h"

namespace vernier::evaluate {
namespace {

const double kOfRange = 1 / std::sqrt(3.0);  // U = 2 u, u = range / (2 sqrt 3)

struct Entry {
  const char* name;
  double PositioningBudget::*value;
};
constexpr std::array<Entry, 7> kEntries = {{{"device", &PositioningBudget::device_um_m},
                                            {"misalignment", &PositioningBudget::misalignment_mm_m},
                                            {"thermometer", &PositioningBudget::thermometer_K},
                                            {"expansion", &PositioningBudget::expansion_um_mK},
                                            {"expansion-range", &PositioningBudget::expansion_range},
                                            {"away", &PositioningBudget::away_from_20_K},
                                            {"drift", &PositioningBudget::drift_um}}};

}  // namespace

void add_to_budget(PositioningBudget& budget, const std::string& words) {
  const auto at = words.find('=');
  const auto number = at == std::string::npos ? std::nullopt : text::parse_number(words.substr(at + 1));
  for (const Entry& entry : kEntries)
    if (number && *number >= 0 && words.substr(0, at) == entry.name) {
      budget.*entry.value = *number;
      budget.given = true;
      return;
    }
  std::string names;
  for (const Entry& entry : kEntries) names += std::string(" ") + entry.name;
  throw text::InputError(fmt::format("--budget {}: of the form device=0.8, for one of{}", words, names));
}

std::vector<BudgetPart> budget_parts(const PositioningBudget& budget, double length_mm) {
  const double length_m = length_mm / 1000;
  const double slope = budget.misalignment_mm_m / 1000;
  return {{"instrument, as calibrated", budget.device_um_m * length_m},
          {"alignment of the instrument to the axis (cosine error)",
           kOfRange * 1e6 * length_m * slope * slope / 2},
          {"temperature of the machine", kOfRange * budget.expansion_um_mK * length_m * budget.thermometer_K},
          {"coefficient of expansion", kOfRange * budget.expansion_range * length_m * budget.away_from_20_K},
          {"drift while it was measured", kOfRange * budget.drift_um}};
}

std::map<std::string, double> budget_uncertainty(const PositioningBudget& budget, double length_mm,
                                                 double runs) {
  constexpr double kMmPerUm = 1e-3;
  double squares = 0;
  for (const BudgetPart& part : budget_parts(budget, length_mm))
    squares += part.expanded_um * part.expanded_um;
  const double all = std::sqrt(squares) * kMmPerUm, drift = kOfRange * budget.drift_um * kMmPerUm;
  return {{"A", all}, {"E", all}, {"M", all}, {"B", drift * std::sqrt(2 / runs)}, {"R", 2 * drift}};
}

}  // namespace vernier::evaluate
