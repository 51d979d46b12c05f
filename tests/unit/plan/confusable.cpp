// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/plan/confusable.h"

#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "tools/diagnose/diagnosis.h"
#include "tools/effects/add.h"
#include "tools/effects/add_string.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"
#include "tools/model/rebind.h"
#include "tools/plan/offers.h"

namespace vernier::plan_test {

using namespace vernier::effects;
using namespace vernier::model;
using namespace vernier::plan;
namespace {

constexpr int kRows = 96;

/// Places in X, Y, Z of row i: X goes up and down once in 24 rows.
struct Spot {
  double x, y, z;
  int sense;
};
Spot spot(int i) {
  const int phase = i % 24;
  const int step = phase < 12 ? phase : 23 - phase;
  return {25 + 50.0 * step, 100.0 * (i / 24) + 50, -30 - 80.0 * ((i / 12) % 3), phase < 12 ? 1 : -1};
}

Confusable backlash_or_lag() {
  Confusable c{"backlash or servo lag at one feed",
               "X[mm],Y[mm],Z[mm],dirX,vX[mm/s],feed[mm/min],t[s]",
               {},
               {"backlash", "servo-lag"},
               {"backlash:axis=X,branch=tool,transform=2,dof=X,form=plain",
                "servo-lag:axis=X,branch=tool,transform=2,dof=X,form=plain"},
               {0.004, 0.004 / 20}};
  for (int i = 0; i < kRows; ++i) {
    const Spot s = spot(i);
    c.rows.push_back(fmt::format("{},{},{},{},{},1200,{}", s.x, s.y, s.z, s.sense, 20 * s.sense, 3 * i));
  }
  return c;
}

Confusable scale_or_thermal() {
  Confusable c{"scale error or thermal scale at one temperature",
               "X[mm],Y[mm],Z[mm],dirX,t[s],T_bed[degC]",
               {},
               {"scale-error", "thermal-scale"},
               {"scale-error:axis=X,branch=tool,transform=2,dof=X,form=plain",
                "thermal-scale:axis=X,input=T_bed,branch=tool,transform=2,dof=X,reference=20,unit=degC,form="
                "plain"},
               {2.4e-5, 4e-6}};
  for (int i = 0; i < kRows; ++i) {
    const Spot s = spot(i);
    c.rows.push_back(fmt::format("{},{},{},{},{},26", s.x, s.y, s.z, s.sense, 20 * i));
  }
  return c;
}

Confusable warmup_or_scale() {
  Confusable c{"warm-up or scale error, time locked to position",
               "X[mm],Y[mm],Z[mm],dirX,t[s]",
               {},
               {"warmup-drift", "scale-error"},
               {"warmup-drift:branch=tool,transform=2,dof=X,form=plain,start.tau=3000",
                "scale-error:axis=X,branch=tool,transform=2,dof=X,form=plain"},
               {0.040, 2.4e-5},
               false};
  for (int i = 0; i < kRows; ++i) {
    // Y and Z vary beside X: in step with X they would turn its scale into squareness and datum.
    c.rows.push_back(
        fmt::format("{},{},{},1,{}", 6 + 6.0 * i, 50 + 100 * (i % 4), -30 - 80 * (i / 4 % 3), 12 * i));
  }
  return c;
}

Confusable drift_or_thermal() {
  Confusable c{"drift of the base or thermal offset, temperature in proportion to time",
               "X[mm],Y[mm],Z[mm],dirX,t[s],T_bed[degC]",
               {},
               {"base-drift", "thermal-offset"},
               {"base-drift:branch=tool,transform=1,dof=X,form=time",
                "thermal-offset:input=T_bed,branch=tool,transform=1,dof=X,reference=20,unit=degC,form=plain"},
               {0.014 / 1900, 0.0035}};
  for (int i = 0; i < kRows; ++i) {
    const Spot s = spot(i);
    c.rows.push_back(fmt::format("{},{},{},{},{},{}", s.x, s.y, s.z, s.sense, 20 * i, 20 + 4.0 * i / kRows));
  }
  return c;
}

Machine true_machine(const Machine& machine, const Confusable& pair, int truth) {
  const Candidate candidate =
      make_candidate(machine, parse_add_string(pair.adds[truth], machine, built_in_effects()));
  Machine with = parse_machine(add_to_machine_text(model_text(), machine, candidate), "truth.xml");
  for (const CandidateUnknown& unknown : linear_unknowns(candidate))
    with.statics[*with.find_static(unknown.name)].value = pair.amplitudes[truth];
  with.statics[*with.find_static("alpha")].value = 3e-5;
  return with;
}

}  // namespace

std::vector<Confusable> confusable_pairs() {
  return {backlash_or_lag(), scale_or_thermal(), warmup_or_scale(), drift_or_thermal()};
}

std::string model_text() {
  return R"(<machine name="three linear axes">
  <variables>
    <static>
      <alpha value="0" nominal="0" unit="rad"/>
      <BaseShift X="0" Y="0" Z="0" rX="0" rY="0" rZ="0"/>
    </static>
    <machineaxes>
      <X rotary="false" min="0" max="600"/>
      <Y rotary="false" min="0" max="400"/>
      <Z rotary="false" min="-300" max="0"/>
    </machineaxes>
  </variables>
  <transforms branch="tool">
    <sixdof n="1" X="0" Y="Y" Z="0" rX="0" rY="0" rZ="0"/>
    <sixdof n="2" X="X" Y="alpha*X" Z="0" rX="0" rY="0" rZ="0"/>
    <sixdof n="3" X="0" Y="0" Z="Z" rX="0" rY="0" rZ="0"/>
  </transforms>
</machine>
)";
}

void read(Measurement& rows, const Machine& machine, const Confusable& pair, int truth, std::uint64_t seed) {
  const Machine with = true_machine(machine, pair, truth);
  const Eigen::VectorXd exact = predict(with, rebind(rows, machine, with));
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> noise(0, kUncertaintyMm);
  for (std::size_t i = 0; i < rows.observations.size(); ++i)
    rows.observations[i].value = exact[static_cast<Eigen::Index>(i)] + noise(engine);
}

Measurement survey(const Confusable& pair, int truth, const Machine& machine, std::uint64_t seed) {
  std::string csv = pair.header + ",x[mm],y[mm],z[mm],u[mm],run\n";
  for (std::size_t i = 0; i < pair.rows.size(); ++i)
    csv += fmt::format("{},0,0,0,{},r{}\n", pair.rows[i], kUncertaintyMm, 4 * i / pair.rows.size() + 1);
  Measurement m = parse_measurement(csv, "survey.csv", machine);
  read(m, machine, pair, truth, seed);
  return m;
}

Measurement random_rows(const Plan& plan, const Measurement& existing, std::uint64_t seed) {
  const Drivers drivers = drivers_of(std::vector<const FittedHypothesis*>{&plan.a, &plan.b});
  constexpr std::size_t kOffers = 1000;
  const Offers offers = offer_rows(plan.machine, existing, drivers, kOffers);
  std::mt19937_64 engine(seed);
  std::vector<std::size_t> which;
  for (std::size_t i = 0; i < plan.rows.rows(); ++i) which.push_back(offers.existing + engine() % kOffers);
  std::sort(which.begin(), which.end(), [&](std::size_t a, std::size_t b) {
    const Column& t = offers.rows.states.time;
    return t[static_cast<Eigen::Index>(a)] < t[static_cast<Eigen::Index>(b)];
  });
  Measurement rows = select_rows(offers.rows, which);
  rows.states.run_names = {kPlanRun};
  for (std::size_t i = 0; i < which.size(); ++i) {
    rows.states.run[i] = 0;
    rows.states.visit[static_cast<Eigen::Index>(i)] = static_cast<double>(i);
  }
  return rows;
}

}  // namespace vernier::plan_test
