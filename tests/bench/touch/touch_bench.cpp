// SPDX-License-Identifier: GPL-3.0-or-later
// Calibration by touching things: error, convergence and cover of the stated intervals, over many simulated
// machines. touch_bench [SEEDS [FIRST]]; exit 1: a goal is not reached.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>

#include "tests/bench/touch/machines.h"
#include "tools/fit/coverage/point_readings.h"
#include "tools/fit/fit.h"
#include "tools/maths/decompositions.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"
#include "tools/model/measurement.h"

using namespace vernier;
using touch_bench::Case;
using touch_bench::Size;

namespace {

struct Tally {
  double sum = 0, worst = 0, scaled = 0;
  int count = 0, covered = 0, judged = 0, converged = 0, fits = 0;
  double seconds = 0;
};

/// Errors at the fresh poses, mm, after the best rigid motion: a free base is no error of the arm.
void judge_poses(const Case& one, const fit::FitResult& result, Tally& tally) {
  const model::Measurement fresh = fit::point_readings(one.fresh);
  model::Machine fitted = result.machine, truth = one.truth;
  fitted.base_shifts.clear();
  truth.base_shifts.clear();
  const model::ParameterSet own(fitted, {});  // the set-ups are the last of the parameters
  const auto n = static_cast<Eigen::Index>(own.size());
  const Eigen::VectorXd off = model::predict(fitted, fresh) - model::predict(truth, fresh);
  const model::Linearisation linear = model::linearise(fitted, fresh, own);
  // Set-ups and the place of the base are no property of the arm.
  const Eigen::MatrixXd motions = fit::rigid_motions(model::forward(fitted, one.fresh).position);
  const Eigen::MatrixXd basis = maths::thin_q(motions);
  const Eigen::VectorXd left = off - basis * (basis.transpose() * off);
  const Eigen::MatrixXd j(linear.jacobian), beside = j - basis * (basis.transpose() * j);
  for (Eigen::Index i = 0; i < left.size(); i += 3) {
    const double error = left.segment<3>(i).norm();
    tally.sum += error;
    tally.worst = std::max(tally.worst, error);
    ++tally.count;
  }
  for (Eigen::Index i = 0; i < left.size(); ++i) {
    const double std =
        std::sqrt(beside.row(i) * result.covariance.topLeftCorner(n, n) * beside.row(i).transpose());
    tally.covered += std::abs(left[i]) <= 1.96 * std ? 1 : 0;
    tally.scaled += std::pow(left[i] / std, 2);
    ++tally.judged;
  }
}

void judge_parameters(const Case& one, const fit::FitResult& result, Tally& tally) {
  for (const std::string& name : one.parameters) {
    const double truth = one.truth.statics[*one.truth.find_static(name)].value;
    for (const fit::ParameterEstimate& estimate : result.estimates) {
      if (estimate.name != name) continue;
      const double error = std::abs(estimate.value - truth);
      tally.sum += one.unit * error;
      tally.worst = std::max(tally.worst, one.unit * error);
      tally.covered += error <= 1.96 * estimate.std ? 1 : 0;
      tally.scaled += std::pow(error / estimate.std, 2);
      ++tally.count;
      ++tally.judged;
    }
  }
}

void run_case(const Case& one, Tally& tally) {
  const model::Machine nominal = model::parse_machine(one.machine, "nominal.xml");
  const model::Measurement rows = model::parse_measurement(one.survey, "survey.csv", nominal);
  const auto begun = std::chrono::steady_clock::now();
  const fit::FitResult result = fit::fit(nominal, rows);
  tally.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  ++tally.fits;
  tally.converged += result.converged && result.absurd.empty() ? 1 : 0;
  if (one.fresh.count > 0)
    judge_poses(one, result, tally);
  else
    judge_parameters(one, result, tally);
}

}  // namespace

int main(int count, char** words) {
  const int seeds = count > 1 ? std::atoi(words[1]) : 10, first = count > 2 ? std::atoi(words[2]) : 1;
  const std::string only = count > 3 ? words[3] : "";
  const struct {
    std::function<Case(std::mt19937_64&)> make;
    const char* unit;
  } cases[] = {
      {[](std::mt19937_64& r) { return touch_bench::robot(r, Size::kDistance); }, "mm"},
      {[](std::mt19937_64& r) { return touch_bench::robot(r, Size::kPlaces); }, "mm"},
      {[](std::mt19937_64& r) { return touch_bench::robot(r, Size::kNothing); }, "mm"},
      {[](std::mt19937_64& r) { return touch_bench::mill(r); }, "urad"},
      {[](std::mt19937_64& r) { return touch_bench::table(r); }, "um"},
      {[](std::mt19937_64& r) { return touch_bench::many(r, 20, 1000); }, "urad"},
      {[](std::mt19937_64& r) { return touch_bench::many(r, 200, 10000); }, "urad"},
  };
  fmt::print("{:28} {:>9} {:>9} {:>5} {:>10} {:>8} {:>7} {:>8} {:>8}\n", "survey", "mean", "worst", "unit",
             "converged", "cover %", "error/u", "seconds", "goal");
  bool reached = true;
  for (const auto& one : cases) {
    Tally tally;
    std::string name;
    double goal = 0;
    for (int seed = first; seed < first + seeds; ++seed) {
      std::mt19937_64 random(static_cast<std::uint64_t>(seed));
      const Case now = one.make(random);
      name = now.name;
      goal = now.goal;
      if (!only.empty() && name.find(only) == std::string::npos) break;
      run_case(now, tally);
    }
    if (tally.fits == 0) continue;
    const double mean = tally.sum / std::max(1, tally.count);
    fmt::print("{:28} {:9.4g} {:9.4g} {:>5} {:5}/{:<4} {:8.1f} {:7.2f} {:8.3f} {:8.3g}\n", name, mean,
               tally.worst, one.unit, tally.converged, tally.fits,
               100.0 * tally.covered / std::max(1, tally.judged),
               std::sqrt(tally.scaled / std::max(1, tally.judged)), tally.seconds / tally.fits, goal);
    std::fflush(stdout);
    reached = reached && mean <= goal && 100 * tally.converged >= 99 * tally.fits;
  }
  return reached ? 0 : 1;
}
