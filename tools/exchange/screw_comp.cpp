// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/exchange/screw_comp.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "tools/exchange/table_text.h"
#include "tools/kinematics/correction.h"
#include "tools/model/machine_reader.h"
#include "tools/model/machine_writer.h"
#include "tools/text/numbers.h"

namespace vernier::exchange {
namespace {

/// What files round: they are written to 1e-6 mm, so two trims may differ by as much.
constexpr double kRounding_mm = 1.01e-6;

std::vector<ScrewPoint> trims_at(const model::Machine& machine, std::size_t axis, const model::States& at,
                                 const std::vector<double>& positions) {
  const std::size_t count = positions.size();
  model::States states = model::select_states(at, std::vector<std::size_t>(2 * count, 0));
  for (std::size_t i = 0; i < 2 * count; ++i) {
    states.axis[axis][static_cast<Eigen::Index>(i)] = positions[i % count];
    states.direction[axis][static_cast<Eigen::Index>(i)] = i < count ? 1 : -1;
  }
  const model::Column offset = kinematics::first_order_offset(machine, states)[axis];
  std::vector<ScrewPoint> points;
  for (std::size_t i = 0; i < count; ++i)
    points.push_back(
        {positions[i], offset[static_cast<Eigen::Index>(i)], offset[static_cast<Eigen::Index>(i + count)]});
  return points;
}

/// How far trims at the quarters of a segment are from its straight line, mm.
double bend_of(const std::vector<ScrewPoint>& five) {
  double worst = 0;
  for (std::size_t k = 1; k < 4; ++k) {
    const double f = static_cast<double>(k) / 4;
    const auto off = [&](double ScrewPoint::*trim) {
      return std::abs(five[k].*trim - (1 - f) * five[0].*trim - f * five[4].*trim);
    };
    worst = std::max({worst, off(&ScrewPoint::forward_trim), off(&ScrewPoint::reverse_trim)});
  }
  return worst;
}

std::vector<double> first_positions(const model::Machine& machine, std::size_t axis) {
  const model::Axis& one = machine.axes[axis];
  std::vector<double> result;
  if (const model::Table* table = machine.table_of(axis)) {
    for (const model::Station& station : table->stations) result.push_back(station.loc);
  } else {
    if (!one.min || !one.max)
      throw text::InputError({machine.file, one.line}, one.name,
                             "this axis needs min and max to be exported");
    result = {*one.min, *one.max};
  }
  if (one.min && *one.min < result.front()) result.insert(result.begin(), *one.min);
  if (one.max && *one.max > result.back()) result.push_back(*one.max);
  return result;
}

/// Positions between which straight lines stay within the tolerance; none where that takes too many.
std::optional<std::vector<double>> positions_within(const model::Machine& machine, std::size_t axis,
                                                    const model::States& at, double tolerance_um) {
  std::vector<double> positions = first_positions(machine, axis);
  for (bool split = true; split;) {
    split = false;
    if (positions.size() > kMostScrewPoints) return std::nullopt;
    std::vector<double> next = {positions.front()};
    for (std::size_t i = 0; i + 1 < positions.size(); ++i) {
      const double a = positions[i], w = positions[i + 1] - a;
      if (1000 * bend_of(trims_at(machine, axis, at, {a, a + w / 4, a + w / 2, a + 0.75 * w, a + w})) >
          tolerance_um) {
        next.push_back(a + w / 2);
        split = true;
      }
      next.push_back(positions[i + 1]);
    }
    positions = std::move(next);
  }
  return positions;
}

/// What would do instead.
std::string way_out(const model::Machine& machine, std::size_t axis, const model::States& at,
                    double tolerance_um) {
  for (const double wider : {0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0})
    if (wider > tolerance_um && positions_within(machine, axis, at, wider))
      return fmt::format("; --tolerance {} would do, --component holds all of it", wider);
  return "; --component holds all of it";
}

}  // namespace

std::vector<ScrewPoint> screw_points(const model::Machine& machine, std::size_t axis, const model::States& at,
                                     double tolerance_um) {
  const auto positions = positions_within(machine, axis, at, tolerance_um);
  if (!positions)
    throw text::InputError(
        {machine.file, 0}, machine.axes[axis].name,
        fmt::format("more than {} lines are needed to stay within {} um{}", kMostScrewPoints, tolerance_um,
                    way_out(machine, axis, at, tolerance_um)));
  return trims_at(machine, axis, at, *positions);
}

std::string screw_text(const std::vector<ScrewPoint>& points, ScrewType type) {
  std::string text;
  for (const ScrewPoint& point : points) {
    const auto value = [&](double trim) {
      const double printed = type == ScrewType::kTrim ? trim : point.nominal - trim;
      return std::abs(printed) < 5e-7 ? 0.0 : printed;  // no "-0.000000"
    };
    text += fmt::format("{:.6f} {:.6f} {:.6f}\n", point.nominal, value(point.forward_trim),
                        value(point.reverse_trim));
  }
  return text;
}

std::vector<ScrewPoint> parse_screw(const std::string& text, const std::string& file, ScrewType type) {
  std::vector<ScrewPoint> points;
  std::istringstream lines(text);
  std::string line;
  for (std::size_t number = 1; std::getline(lines, line); ++number) {
    const text::Place place{file, number};
    std::istringstream words(line);
    std::vector<double> three;
    for (std::string word; words >> word;) {
      const auto value = text::parse_number(word);
      if (!value) throw text::InputError(place, word, "not a number: the controller would stop reading here");
      three.push_back(*value);
    }
    if (three.size() != 3)
      throw text::InputError(place, line,
                             "a line is nominal, forward, reverse: the controller would stop reading here");
    if (!points.empty() && three[0] <= points.back().nominal)
      throw text::InputError(place, line, "positions must increase");
    if (points.size() == kMostScrewPoints)
      throw text::InputError(place, line,
                             fmt::format("the controller keeps only {} lines", kMostScrewPoints));
    if (type == ScrewType::kActual)
      points.push_back({three[0], three[0] - three[1], three[0] - three[2]});
    else
      points.push_back({three[0], three[1], three[2]});
  }
  if (points.size() < 2) throw text::InputError({file, 0}, "", "a table needs two lines at least");
  return points;
}

std::string screw_into_machine(const std::string& text, const model::Machine& machine, std::size_t axis,
                               const std::vector<ScrewPoint>& points, const std::string& reversal) {
  const std::string& name = machine.axes[axis].name;
  const auto own =
      std::find_if(model::kSixDofNames.begin(), model::kSixDofNames.begin() + 3, [&](const char* letter) {
        return name.find(*letter) != std::string::npos;  // X, Xm, X1 …
      });
  if (own == model::kSixDofNames.begin() + 3)
    throw text::InputError({machine.file, 0}, name,
                           "which column of its table is along this axis? Its name has no X, Y or Z");
  std::vector<double> positions;
  for (const ScrewPoint& point : points) positions.push_back(point.nominal);
  model::Table table = empty_table(machine, axis, positions);
  table.interpolation = model::Interpolation::kLinear;
  const double half = (points[0].reverse_trim - points[0].forward_trim) / 2;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::abs((points[i].reverse_trim - points[i].forward_trim) / 2 - half) > kRounding_mm)
      throw text::InputError(
          {}, text::number_text(points[i].nominal),
          "the reversal is not the same at all positions: a machine file has one term for it");
    table.stations[i].value[static_cast<std::size_t>(own - model::kSixDofNames.begin())] =
        nine_decimals(-(points[i].forward_trim + points[i].reverse_trim) / 2);
  }
  model::Machine next = machine;
  if (!reversal.empty()) {
    const auto index = machine.find_static(reversal);
    if (!index) throw text::InputError({machine.file, 0}, reversal, "no static of that name");
    next.statics[*index].value = nine_decimals(half);
  }
  check_used(machine, table);
  const std::string result = set_table(model::update_machine_text(text, next, false), next, table);
  const model::Machine back = model::parse_machine(result, machine.file);
  const std::vector<ScrewPoint> again = trims_at(back, axis, model::make_states(1, back), positions);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double off = std::max(std::abs(again[i].forward_trim - points[i].forward_trim),
                                std::abs(again[i].reverse_trim - points[i].reverse_trim));
    if (off > kRounding_mm)
      throw text::InputError(
          {machine.file, 0}, name,
          fmt::format("this machine would not have the trims of the file: {:.4g} um off at {} (a reversal "
                      "wants --reversal STATIC; other errors of this axis have to be 0)",
                      1000 * off, points[i].nominal));
  }
  return result;
}

}  // namespace vernier::exchange
