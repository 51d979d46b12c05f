// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/blame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "tools/fit/decisions.h"

namespace vernier::fit {
namespace {

/// Number of names in a combination, and of combinations, that a person can read.
constexpr std::size_t kMostNames = 5, kMostGroups = 4;
/// Share of the largest part of a step. Smaller parts follow the others and are not to blame.
constexpr double kPart = 0.2;

/// "th4 - 0.83 d5 + 0.31 a3": the largest part has the factor 1; in units of each scale.
std::string combination(const FitResult& result, const Eigen::VectorXd& step) {
  std::vector<std::pair<double, std::size_t>> parts;
  const double largest = step.cwiseAbs().maxCoeff();
  for (std::size_t i = 0; i < result.parameters.size(); ++i)
    if (const double part = step[static_cast<Eigen::Index>(i)]; std::abs(part) >= kPart * largest)
      parts.emplace_back(part, i);
  std::sort(parts.begin(), parts.end(),
            [](const auto& a, const auto& b) { return std::abs(a.first) > std::abs(b.first); });
  std::string text = result.parameters[parts.front().second].name;
  for (std::size_t k = 1; k < parts.size() && k < kMostNames; ++k) {
    const double factor = parts[k].first / parts.front().first;
    text += fmt::format(" {} {:.2g} {}", factor < 0 ? "-" : "+", std::abs(factor),
                        result.parameters[parts[k].second].name);
  }
  if (parts.size() > kMostNames) text += fmt::format(" and {} smaller parts", parts.size() - kMostNames);
  return text;
}

}  // namespace

std::string blame_of(const FitResult& result, const Settled& end, std::size_t readings) {
  std::string text = fmt::format("{} readings for {} free parameters", readings, result.parameters.size());
  const Eigen::VectorXd& step = end.last_step;
  if (!end.converged && static_cast<std::size_t>(step.size()) == result.parameters.size() &&
      step.allFinite() && step.cwiseAbs().maxCoeff() > 0)
    text += fmt::format("; the last step still moved the combination {} (in units of each scale)",
                        combination(result, step));
  const std::vector<Decision> open = decisions_of(result, kMostGroups);
  for (std::size_t i = 0; i < open.size(); ++i) {
    std::string names;
    for (std::size_t k = 0; k < open[i].parameters.size() && k < kMostNames; ++k)
      names += (k > 0 ? ", " : "") + open[i].parameters[k];
    if (open[i].parameters.size() > kMostNames)
      names += fmt::format(" and {} more", open[i].parameters.size() - kMostNames);
    text += (i == 0 ? "; the readings do not determine " : " | ") + names;
  }
  return text + "; hold some of these parameters (--hold NAME), or measure more and other poses";
}

}  // namespace vernier::fit
