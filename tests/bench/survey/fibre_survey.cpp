// SPDX-License-Identifier: GPL-3.0-or-later
// A laser-tracker survey of the fibre placement machine (Rudberg, SAE 2012) is simulated and fitted from the
// nominal machine: every axis with a table of true errors, axes out of square by tens of mrad, a ram that
// bends, five tool points known, two set-ups of the tracker. Fit data: stations of each axis, rotary sweeps,
// random poses. Check data: random poses and a bow-tie path through the volume. Prints the error of the check
// rows over the tracker's uncertainty, staged and all at once. Arguments: seed, poses.

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

#include "tools/fit/fit.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"
#include "tools/text/files.h"

namespace {

using namespace vernier;
using namespace vernier::fit;
using namespace vernier::model;
using namespace vernier::text;
using Random = std::mt19937_64;

constexpr double kTrackerMm = 0.1,
                 kOrientationDeg = 0.014;  // the paper's position and orientation uncertainty

struct Range {
  const char* axis;
  double low, high;
};
constexpr Range kRanges[] = {{"Xm", 2750, 20000}, {"Ym", -2700, 3900}, {"Zm", -975, 3625}, {"Cpm", -90, 90},
                             {"Am", -45, 90},     {"Bm", -45, 45},     {"Cm", 0, 360}};

/// The published file with its tables freed, the tool points held, and one BaseShift for each set-up.
Machine nominal_model() {
  std::string text = read_file(VERNIER_SOURCE_DIR "/tests/data/electroimpact/kinematic_before.xml");
  for (std::size_t at = 0; (at = text.find("<table axis=", at)) != std::string::npos; at += 8)
    text.replace(at, 6, "<table fit=\"X Y Z rX rY rZ\"");
  const std::size_t shift = text.find("<BaseShift");
  text.replace(shift, text.find("/>", shift) + 2 - shift, "<BaseShift run=\"s1\"/><BaseShift run=\"s2\"/>");
  return parse_machine(text, "fibre.xml");
}

/// A table's true column: a smooth curve of that size.
void bend(Table& table, std::size_t column, double size, Random& random) {
  std::normal_distribution<double> normal(0, 1);
  const double a = normal(random), b = normal(random), c = normal(random), d = normal(random);
  const double low = table.stations.front().loc, width = table.stations.back().loc - low;
  for (Station& station : table.stations) {
    const double s = 2 * M_PI * (station.loc - low) / width;
    station.value[column] =
        size * (a * std::sin(s) + b * std::cos(s) + c * std::sin(2 * s) + d * std::cos(3 * s)) / 2;
  }
}

Machine true_machine(Random& random) {
  Machine machine = nominal_model();
  std::normal_distribution<double> normal(0, 1);
  for (Table& table : machine.tables)
    for (std::size_t c = 0; c < 6; ++c) bend(table, c, c < 3 ? 0.3 : 0.01, random);
  for (Static& item : machine.statics) {
    if (item.hidden) continue;
    const bool flex = item.name.find("flex") != std::string::npos,
               angle = item.name.find("r") == 1 || item.name.find("r") == 2;
    if (flex)
      item.value += 0.2 * std::abs(normal(random));  // deg per 1e4 mm of ram and per sine of the wrist
    else if (angle)
      item.value += 1.0 * normal(random);  // deg: 17 mrad
    else
      item.value += 0.5 * normal(random);  // mm
  }
  for (BaseShift& shift : machine.base_shifts)
    for (std::size_t c = 0; c < 6; ++c) shift.value[c] = (c < 3 ? 50 : 2) * normal(random);
  return machine;
}

/// A position and, in a row of its own since it has an uncertainty of its own, an orientation.
std::string row_text(const double (&q)[7], int tool, const char* run, const char* role) {
  std::string pose;
  for (const double value : q) pose += fmt::format("{:.4f},", value);
  return pose + fmt::format("{},0,0,0,,,,{},{},{}\n", tool, kTrackerMm, run, role) + pose +
         fmt::format("{},,,,0,0,0,{},{},{}\n", tool, kOrientationDeg, run, role);
}

std::string poses(std::size_t count, Random& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  constexpr int kTools[] = {2, 3, 4, 5, 10};
  std::string text =
      "Xm[mm],Ym[mm],Zm[mm],Cpm[deg],Am[deg],Bm[deg],Cm[deg],TP,x[mm],y[mm],z[mm],rx[deg],ry[deg],rz[deg],"
      "u[mm],run,role\n";
  const auto anywhere = [&](double(&q)[7]) {
    for (std::size_t i = 0; i < 7; ++i)
      q[i] = kRanges[i].low + (kRanges[i].high - kRanges[i].low) * unit(random);
  };
  for (std::size_t i = 0; i < count; ++i) {
    double q[7];
    anywhere(q);
    const char* role = "fit";
    if (i % 10 == 9) {
      role = "check";
      if (i % 20 == 19) {  // the bow tie: both diagonals of the volume, the wrist turning on the way
        const double s = unit(random);
        for (std::size_t k = 0; k < 3; ++k)
          q[k] = kRanges[k].low + (kRanges[k].high - kRanges[k].low) * (k == 1 && i % 40 == 39 ? 1 - s : s);
      }
    } else if (i % 10 < 3) {  // one axis along its stations, the others in one of a few places
      const std::size_t moving = i / 10 % 7;
      for (std::size_t k = 0; k < 7; ++k)
        if (k != moving)
          q[k] = kRanges[k].low + (kRanges[k].high - kRanges[k].low) * std::round(4 * unit(random)) / 4;
    }
    text += row_text(q, kTools[i % 5], i / 7 % 2 == 0 ? "s1" : "s2", role);
  }
  return text;
}

void measure(const Machine& truth, Measurement& m, Random& random) {
  std::normal_distribution<double> normal(0, 1);
  // The readings of a rotation vector repeat every 360 deg: take the truth's own branch first.
  Eigen::VectorXd reading = predict(truth, m);
  for (std::size_t i = 0; i < m.observations.size(); ++i)
    m.observations[i].value =
        reading[static_cast<Eigen::Index>(i)] +
        (is_rotation(m.observations[i].kind) ? kOrientationDeg : kTrackerMm) * normal(random);
}

void report(const char* how, const FitResult& result, const Measurement& m, double seconds) {
  std::size_t within = 0, count = 0;
  double squares = 0, worst = 0;
  for (std::size_t i = 0; i < m.observations.size(); ++i) {
    const Observation& o = m.observations[i];
    if (m.check[o.row] == 0 || is_rotation(o.kind)) continue;
    const double e = std::abs(result.residual[static_cast<Eigen::Index>(i)]) / kTrackerMm;
    squares += e * e;
    worst = std::max(worst, e);
    within += e <= 3 ? 1U : 0U;
    ++count;
  }
  fmt::print("{:<12} {} parameters, rank {}, {} observations, {:.1f} s, {} iterations{}\n", how,
             result.parameters.size(), result.observability.rank, result.before.count, seconds,
             result.iterations, result.converged ? "" : ", NOT CONVERGED");
  fmt::print(
      "{:<12} check rows: rms {:.3f} u, {:.2f} % within 3 u, worst {:.2f} u; fit rows {:.1f} um -> {:.1f} "
      "um\n",
      "", std::sqrt(squares / static_cast<double>(count)),
      100.0 * static_cast<double>(within) / static_cast<double>(count), worst, *result.before.rms_um,
      *result.after.rms_um);
}

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

int main(int argc, char** argv) {
  const auto seed = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1;
  const auto rows = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 4000;
  fmt::print("seed {}, {} poses\n", seed, rows);
  Random random(seed);
  const Machine truth = true_machine(random), start = nominal_model();
  Measurement m = parse_measurement(poses(rows, random), "survey.csv", start);
  measure(truth, m, random);
  FitOptions staged;
  staged.stages = {{"BaseShift*"}, {"BaseShift*", "*off", "l*", "cl*", "*flex"}};
  for (const bool in_stages : {true, false}) {
    const double from = now_s();
    const FitResult result = fit::fit(start, m, in_stages ? staged : FitOptions{});
    report(in_stages ? "in stages" : "all at once", result, m, now_s() - from);
  }
  return 0;
}
