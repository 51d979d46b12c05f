// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/decisions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "tools/maths/factors.h"

namespace vernier::fit {
namespace {

/// The parameter, or the column of a table that it belongs to.
std::string column_of(const FitResult& result, std::size_t i) {
  const model::Parameter& p = result.parameters[i];
  if (p.kind != model::ParameterKind::kStation) return p.name;
  return "table." + result.machine.axes[result.machine.tables[p.item].axis].name + "." +
         model::kSixDofNames[p.column];
}

/// Returns one standard uncertainty of a parameter at the edge of the measured box. A coefficient
/// of unknown unit counts by its scale, which corresponds to three times the misfit.
double reach_um(const FitResult& result, std::size_t i) {
  const ParameterEstimate& e = result.estimates[i];
  if (e.unit == "mm") return maths::kUmPerMm * e.std;
  if (e.unit == "deg") return maths::kUmPerMm * e.std * maths::kRadPerDeg * result.reach_mm;
  if (e.unit == "rad") return maths::kUmPerMm * e.std * result.reach_mm;
  return e.scale > 0 ? maths::kUmPerMm * 3 * result.misfit_mm * e.std / e.scale : 0;
}

struct DecisionGroup {
  std::vector<std::string> names;
  double reach_um = 0;
  std::size_t open = 0, unseen = 0;  // parameters set by convention, and parameters without readings
  bool moved = false;                // the readings changed a parameter that they hardly measure
};

std::string first_names(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 6;  // names in a line that a person can read
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < kMost; ++i) text += (i > 0 ? ", " : "") + names[i];
  return names.size() > kMost ? text + fmt::format(" and {} more", names.size() - kMost) : text;
}

Decision decision_of(const DecisionGroup& group) {
  const std::string names = first_names(group.names);
  const char* said =
      group.unseen == group.open && group.moved ? "hardly measured; as uncertain as nominal +- scale"
      : group.unseen == group.open              ? "not measured; stays at nominal +- scale"
      : group.names.size() > 1
          ? "the readings do not distinguish these parameters, so the fit sets them to the values nearest "
            "nominal"
          : "the readings determine only a combination of this parameter with others; the undetermined part "
            "is as near to nominal as possible";
  return {group.names, group.reach_um,
          fmt::format("{}: {}; +- {:.3g} um at the edge of the measured box", names, said, group.reach_um)};
}

}  // namespace

std::vector<Decision> decisions_of(const FitResult& result, std::size_t most) {
  // Combinations join the columns that take part in them. A column that is open by itself is
  // listed alone.
  std::map<std::string, std::string> head;
  const auto root = [&](std::string name) {
    while (head.contains(name) && head[name] != name) name = head[name];
    return name;
  };
  const auto is_set_up = [&](std::size_t i) { return model::is_set_up(result.parameters[i].kind); };
  for (const auto& parts : result.observability.unidentifiable) {
    std::string first;
    for (const std::size_t i : parts) {
      if (is_set_up(i)) continue;
      const std::string name = root(column_of(result, i));
      if (first.empty())
        first = name;
      else
        head[name] = first;
    }
  }
  std::map<std::string, DecisionGroup> groups;
  for (std::size_t i = 0; i < result.estimates.size(); ++i) {
    const Origin from = result.estimates[i].from;
    if (is_set_up(i) || from == Origin::kData) continue;
    const std::string column = column_of(result, i);
    DecisionGroup& group = groups[root(column)];
    if (std::find(group.names.begin(), group.names.end(), column) == group.names.end())
      group.names.push_back(column);
    group.reach_um = std::max(group.reach_um, reach_um(result, i));
    ++group.open;
    group.unseen += from == Origin::kPrior ? 1 : 0;
    group.moved = group.moved || result.estimates[i].moved();
  }
  std::vector<Decision> list;
  for (const auto& [name, group] : groups) list.push_back(decision_of(group));
  std::sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.reach_um > b.reach_um; });
  if (list.size() > most) list.resize(most);
  return list;
}

namespace {

/// Number of names in a combination, and of combinations, that a person can read.
constexpr std::size_t kMostNames = 5, kMostGroups = 4;
/// Share of the largest part of a step. Smaller parts follow the others and are left out.
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

std::string blame_of(const FitResult& result, const Eigen::VectorXd& step, std::size_t readings) {
  std::string text = fmt::format("{} readings for {} free parameters", readings, result.parameters.size());
  if (static_cast<std::size_t>(step.size()) == result.parameters.size() && step.allFinite() &&
      step.cwiseAbs().maxCoeff() > 0)
    text += fmt::format("; the last iteration still changed the combination {} (in units of each scale)",
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
  return fmt::format("{}; fix some of these parameters (--hold NAME), or measure more and other poses", text);
}

}  // namespace vernier::fit
