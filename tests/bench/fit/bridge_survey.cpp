// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/fit/bridge_survey.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <tuple>

#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"

namespace vernier::bench {

using namespace vernier::model;
namespace {

/// The tool's length along one direction, with what each set-up adds.
std::string tool_text(char direction, std::size_t column, Targets targets) {
  std::string text = fmt::format("tool{}", direction);
  for (std::size_t i = 0; i < kSetUps && targets == Targets::kFiveTargets; ++i)
    text += fmt::format("+({})*run(&quot;s{}&quot;)", kOffset_mm[i][column], i);
  return text;
}

std::string machine_text(std::size_t stations, Targets targets) {
  std::string tables, shifts;
  for (const auto& [axis, low, high] : {std::tuple{"X", 0.0, 600.0}, {"Y", 0.0, 400.0}, {"Z", -300.0, 0.0}}) {
    tables += fmt::format("<table axis=\"{}\" fit=\"X Y Z rX rY rZ\">\n", axis);
    for (std::size_t i = 0; i < stations; ++i)
      tables += fmt::format("<station loc=\"{}\"/>\n",
                            low + (high - low) * static_cast<double>(i) / static_cast<double>(stations - 1));
    tables += "</table>\n";
  }
  for (std::size_t i = 0; i < kSetUps; ++i) shifts += fmt::format("<BaseShift run=\"s{}\"/>", i);
  return "<machine name=\"bridge\"><variables><static><toolx value=\"20\" unit=\"mm\"/><tooly value=\"-30\" "
         "unit=\"mm\"/><toolz value=\"-120\" unit=\"mm\"/>" +
         shifts +
         "</static><machineaxes><X min=\"0\" max=\"600\"/><Y min=\"0\" max=\"400\"/><Z min=\"-300\" "
         "max=\"0\"/></machineaxes><comptables>\n" +
         tables +
         "</comptables></variables><transforms>"
         "<sixdof n=\"1\" X=\"lYx\" Y=\"Y+lYy\" Z=\"lYz\" rX=\"rYx\" rY=\"rYy\" rZ=\"rYz\"/>"
         "<sixdof n=\"2\" X=\"X+lXx\" Y=\"lXy\" Z=\"lXz\" rX=\"rXx\" rY=\"rXy\" rZ=\"rXz\"/>"
         "<sixdof n=\"3\" X=\"lZx\" Y=\"lZy\" Z=\"Z+lZz\" rX=\"rZx\" rY=\"rZy\" rZ=\"rZz\"/>"
         "<sixdof n=\"4\" X=\"" +
         tool_text('x', 0, targets) + "\" Y=\"" + tool_text('y', 1, targets) + "\" Z=\"" +
         tool_text('z', 2, targets) + "\"/></transforms></machine>";
}

std::string points_text(std::size_t points, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::string text = "X[mm],Y[mm],Z[mm],x[mm],y[mm],z[mm],u[mm],run\n";
  for (std::size_t i = 0; i < points; ++i) {
    const double x = 600 * unit(random), y = 400 * unit(random), z = -300 * unit(random);
    text +=
        fmt::format("{:.4f},{:.4f},{:.4f},0,0,0,{},s{}\n", x, y, z, kUncertainty_mm, i * kSetUps / points);
  }
  return text;
}

/// Two harmonics of random size along the axis: what guideways and screws do.
void bend(Table& table, std::mt19937_64& random) {
  constexpr double kLength_mm = 0.02, kAngle_deg = 0.00115;  // 20 um, 20 urad
  std::normal_distribution<double> normal(0, 1);
  const double low = table.stations.front().loc, width = table.stations.back().loc - low;
  for (std::size_t c = 0; c < 6; ++c) {
    const double size = c < 3 ? kLength_mm : kAngle_deg;
    const double a = size * normal(random), b = size * normal(random), d = size * normal(random);
    for (Station& station : table.stations) {
      const double s = std::numbers::pi * (station.loc - low) / width;
      station.value[c] = a * std::sin(s) + b * std::sin(2 * s) + d * std::cos(3 * s);
    }
  }
}

/// Set-ups as a tracker's software knows them.
void align(Machine& start, const Machine& truth) {
  for (std::size_t i = 0; i < kSetUps; ++i)
    for (std::size_t c = 0; c < 6; ++c) {
      const double step = c < 3 ? 0.1 : 0.01;  // mm, deg
      start.base_shifts[i].value[c] = step * std::round(truth.base_shifts[i].value[c] / step);
    }
}

}  // namespace

Survey make_survey(std::size_t stations, std::size_t points, Targets targets, Start start,
                   std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Survey survey;
  survey.targets = targets;
  survey.start = parse_machine(machine_text(stations, targets), "bridge.xml");
  survey.readings = parse_measurement(points_text(points, random), "survey.csv", survey.start);
  Machine truth = survey.start;
  for (Table& table : truth.tables) bend(table, random);
  std::normal_distribution<double> normal(0, 1);
  for (BaseShift& shift : truth.base_shifts)
    for (std::size_t c = 0; c < 6; ++c) shift.value[c] = (c < 3 ? 100 : 2) * normal(random);
  if (start == Start::kAligned) align(survey.start, truth);
  const Eigen::VectorXd reading = predict(truth, survey.readings);
  for (std::size_t i = 0; i < survey.readings.observations.size(); ++i)
    survey.readings.observations[i].value =
        reading[static_cast<Eigen::Index>(i)] + kUncertainty_mm * normal(random);
  return survey;
}

}  // namespace vernier::bench
