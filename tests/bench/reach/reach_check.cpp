// SPDX-License-Identifier: GPL-3.0-or-later
// What a fitted machine is worth where nobody measured: surveys with nothing hidden, fitted, and compared
// with the true machine at fresh poses with a tool that was not measured.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "tests/support/hidden_survey.h"
#include "tests/support/hidden_survey_family.h"
#include "tools/fit/coverage/reach.h"
#include "tools/fit/fit.h"
#include "tools/maths/alignment.h"
#include "tools/maths/decompositions.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"
#include "tools/text/files.h"

namespace {

using namespace vernier;
using namespace vernier::fit;
using namespace vernier::model;
using namespace vernier::text;
using support::Family;

struct Options {
  std::vector<std::string> families = {"bridge", "column", "five-axis", "fibre", "robot"};
  std::size_t count = 10, rows = 400, poses = 300;
  std::uint64_t seed = 1;
  double part = 1;  // of every axis' range that is measured, around its middle
  double ratio = 10;
  bool three_tools = false, verbose = false;
  std::string effect;  // hidden in every survey, which then goes through `improve`
  std::string vernier = VERNIER_BIN_DIR "/vernier";
};

constexpr std::array<std::array<double, 3>, 3> kTools = {{{0, 0, 0}, {120, 0, -40}, {-30, 100, -90}}};
constexpr std::array<double, 3> kFreshTool = {50, -50, -80};

/// A tool that the measurement file names, as three more inputs at the end of the chain.
std::string with_tool_inputs(std::string text) {
  const std::string inputs = "<qTx unit=\"mm\"/><qTy unit=\"mm\"/><qTz unit=\"mm\"/>";
  if (const auto at = text.find("<inputs>"); at != std::string::npos)
    text.insert(at + 8, inputs);
  else
    text.insert(text.find("</machineaxes>") + 14, "<inputs>" + inputs + "</inputs>");
  const auto tool = text.find("<transforms", text.find("branch=\"tool\"") == std::string::npos
                                                 ? 0
                                                 : text.rfind("<transforms", text.find("branch=\"tool\"")));
  return text.insert(text.find("</transforms>", tool), "<sixdof X=\"qTx\" Y=\"qTy\" Z=\"qTz\"/>");
}

struct Outcome {
  double before = 0, after = 0, noise = 0, fit_rms = 0;
  double oracle = 0;  // what a fit leaves that knows which parameters of the truth differ from nominal
  double angle = 0, true_angle = 0;  // largest of the tables, deg
  std::size_t covered = 0, asked = 0;
  double seconds = 0;
  bool converged = false;
};

double rms_aligned(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to) {
  return 1000 * std::sqrt(maths::aligned_error(maths::align(from, to), from, to).squaredNorm() /
                          static_cast<double>(from.cols()));
}

double largest_angle(const Machine& machine) {
  double largest = 0;
  for (const Table& table : machine.tables)
    for (const Station& station : table.stations)
      for (std::size_t c = 3; c < 6; ++c)
        if (table.free[c]) largest = std::max(largest, std::abs(station.value[c]));
  return largest;
}

/// How much `of` changes with each parameter: central differences, exact to 1e-8 of what is fitted here.
template <class Function>
Eigen::MatrixXd slope(const Machine& machine, const ParameterSet& parameters, const Function& of) {
  const Eigen::VectorXd point = parameters.get(machine);
  Eigen::MatrixXd out;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const double step = 1e-4;
    Machine above = machine, below = machine;
    Eigen::VectorXd to = point;
    to[column] += step;
    parameters.set(above, to);
    to[column] -= 2 * step;
    parameters.set(below, to);
    const Eigen::VectorXd change = (of(above) - of(below)) / (2 * step);
    if (out.size() == 0) out.resize(change.size(), static_cast<Eigen::Index>(parameters.size()));
    out.col(column) = change;
  }
  return out;
}

/// rms at the fresh states of plain least squares over those parameters alone that the truth has (and the
/// set-up), begun at the truth: what the rows do not determine at all stays true.
double oracle_rms(const Machine& truth, const Machine& nominal, const Measurement& m, const States& fresh) {
  const ParameterSet parameters(truth, {});
  const Eigen::VectorXd there = parameters.get(truth), start = parameters.get(nominal);
  const Eigen::VectorXd weight =
      Eigen::VectorXd::NullaryExpr(static_cast<Eigen::Index>(m.observations.size()), [&](Eigen::Index i) {
        return 1 / m.uncertainty[static_cast<Eigen::Index>(m.observations[static_cast<std::size_t>(i)].row)];
      });
  Eigen::MatrixXd rows = slope(truth, parameters, [&](const Machine& x) { return predict(x, m); });
  Eigen::MatrixXd places = slope(truth, parameters, [&](const Machine& x) {
    const Eigen::Matrix3Xd p = forward(x, fresh).position;
    return Eigen::VectorXd(p.reshaped());
  });
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const bool same = there[column] == start[column] && parameters[i].kind != ParameterKind::kBaseShift;
    if (same) rows.col(column).setZero();
    const double length = rows.col(column).norm();
    if (length < 1e-9) {  // nothing that a reading sees
      rows.col(column).setZero();
      continue;
    }
    rows.col(column) /= length;
    places.col(column) /= length;
  }
  const Eigen::VectorXd noise = weight.cwiseProduct(residuals(truth, m));
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(1e-7);
  solver.compute(weight.asDiagonal() * rows);
  const Eigen::VectorXd moved = places * solver.solve(noise);
  const Eigen::Matrix3Xd real = forward(truth, fresh).position;
  return rms_aligned(real + moved.reshaped(3, real.cols()), real);
}

/// The rows whose axes stand in the middle part of their ranges.
Measurement middle_of(const Measurement& m, const support::Geometry& g, double part) {
  std::vector<std::size_t> keep;
  for (std::size_t row = 0; row < m.rows(); ++row) {
    bool inside = true;
    for (std::size_t i = 0; i < g.axes.size(); ++i) {
      const double middle = (g.axes[i].low + g.axes[i].high) / 2, half = (g.axes[i].high - g.axes[i].low) / 2;
      inside = inside && std::abs(m.states.axis[i][static_cast<Eigen::Index>(row)] - middle) <= part * half;
    }
    if (inside) keep.push_back(row);
  }
  return select_rows(m, keep);
}

Outcome judge(const support::HiddenSurvey& survey, const Options& o, std::mt19937_64& random) {
  const support::Geometry g = support::geometry_of(survey.spec.family);
  const std::string true_text = with_tool_inputs(survey.truth), model_text = with_tool_inputs(survey.model);
  const Machine truth = parse_machine(true_text, "truth.xml"), model = parse_machine(model_text, "model.xml");
  Measurement m = parse_measurement(survey.csv, "survey.csv", model);
  if (o.part < 1) m = middle_of(m, g, o.part);
  std::size_t tx = 0;
  for (std::size_t i = 0; i < model.inputs.size(); ++i)
    if (model.inputs[i].name == "qTx") tx = i;
  std::normal_distribution<double> normal;
  if (o.three_tools)
    for (std::size_t row = 0; row < m.rows(); ++row) {
      const auto& tool = kTools[random() % 3];
      for (std::size_t c = 0; c < 3; ++c) m.states.input[tx + c][static_cast<Eigen::Index>(row)] = tool[c];
    }
  const Eigen::VectorXd exact = predict(truth, m);
  Outcome out;
  for (std::size_t i = 0; i < m.observations.size(); ++i) {
    const double u = m.uncertainty[static_cast<Eigen::Index>(m.observations[i].row)];
    m.observations[i].value = exact[static_cast<Eigen::Index>(i)] + u * normal(random);
    out.noise = 1000 * u;
  }
  const auto begin = std::chrono::steady_clock::now();
  const FitResult result = fit::fit(model, m);
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  out.converged = result.converged;
  out.fit_rms = result.after.rms_um.value_or(0);

  States fresh = make_states(o.poses, model.axes.size(), std::vector<double>(model.inputs.size(), 0.0));
  for (std::size_t i = 0; i < model.inputs.size(); ++i) {
    fresh.input[i].setConstant(model.inputs[i].reference);
    for (const auto& [name, value] : g.held)
      if (model.inputs[i].name == name) fresh.input[i].setConstant(value);
    if (i >= tx && i < tx + 3) fresh.input[i].setConstant(kFreshTool[i - tx]);
  }
  for (std::size_t i = 0; i < g.axes.size(); ++i) {
    std::uniform_real_distribution<double> place(g.axes[i].low, g.axes[i].high);
    for (double& q : fresh.axis[i]) q = place(random);
  }
  const Eigen::Matrix3Xd real = forward(truth, fresh).position;
  out.before = rms_aligned(forward(nominal_machine(model), fresh).position, real);
  out.after = rms_aligned(forward(result.machine, fresh).position, real);
  // With one tool its steps leave the neighbourhood in which they mean anything.
  if (o.three_tools) out.oracle = oracle_rms(truth, nominal_machine(model), m, fresh);
  out.angle = largest_angle(result.machine);
  out.true_angle = largest_angle(truth);

  const auto covariance = Reach(result.machine).covariance(fresh);
  const Eigen::Matrix3Xd said = forward(result.machine, fresh).position;
  const Eigen::Matrix3Xd off = maths::aligned_error(maths::align(said, real), said, real);
  for (Eigen::Index i = 0; i < off.cols(); ++i)
    for (Eigen::Index c = 0; c < 3; ++c) {
      const double std = std::sqrt(covariance[static_cast<std::size_t>(i)](c, c));
      out.covered += std::abs(off(c, i)) <= 1.959964 * std ? 1 : 0;
      ++out.asked;
    }
  return out;
}

/// States at fresh poses for one of the machines; inputs at their reference, every axis come to from below or
/// above.
States fresh_states(const Machine& machine, const support::Geometry& g, std::size_t count,
                    std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<double> references;
  for (const Input& input : machine.inputs) {
    double value = input.reference;
    for (const auto& [name, held] : g.held)
      if (input.name == name) value = held;
    references.push_back(value);
  }
  States states = make_states(count, machine.axes.size(), references);
  for (std::size_t i = 0; i < g.axes.size(); ++i) {
    std::uniform_real_distribution<double> place(g.axes[i].low, g.axes[i].high);
    for (double& q : states.axis[i]) q = place(random);
    for (double& sense : states.direction[i]) sense = random() % 2 == 0 ? 1 : -1;
  }
  return states;
}

/// The survey as files through `vernier improve`; the machine of the last rung against the truth.
Outcome judge_improved(const support::HiddenSurvey& survey, const Options& o) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / fmt::format("reach_check_{}", getpid());
  fs::remove_all(folder);
  fs::create_directories(folder);
  write_file((folder / "model.xml").string(), survey.model);
  write_file((folder / "survey.csv").string(), survey.csv);
  const std::string command =
      fmt::format("{} improve {}/model.xml {}/survey.csv -o {}/better --yes >/dev/null 2>&1", o.vernier,
                  folder.string(), folder.string(), folder.string());
  Outcome out;
  const auto begin = std::chrono::steady_clock::now();
  if (std::system(command.c_str()) != 0) return out;
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  out.converged = true;
  fs::path last;
  for (const auto& entry : fs::directory_iterator(folder / "better"))
    if (entry.path().extension() == ".xml" && entry.path().filename().string() > last.filename().string())
      last = entry.path();
  const support::Geometry g = support::geometry_of(survey.spec.family);
  const Machine truth = with_tool(parse_machine(survey.truth, "truth.xml"), kFreshTool);
  const Machine model = with_tool(parse_machine(survey.model, "model.xml"), kFreshTool);
  const Machine improved = with_tool(read_machine(last.string()), kFreshTool);
  const auto points = [&](const Machine& machine) {
    return forward(machine, fresh_states(machine, g, o.poses, survey.spec.seed)).position;
  };
  const Eigen::Matrix3Xd real = points(truth);
  out.before = rms_aligned(points(nominal_machine(model)), real);
  out.after = rms_aligned(points(improved), real);
  out.angle = largest_angle(improved);
  out.true_angle = largest_angle(truth);
  out.asked = 1;
  fs::remove_all(folder);
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  CLI::App app{"Fitted machines at fresh poses with a tool that nobody measured"};
  app.add_option("--family", o.families, "bridge column five-axis fibre robot gantry horizontal-arm");
  app.add_option("-n", o.count, "surveys of each family");
  app.add_option("--rows", o.rows, "rows of a survey");
  app.add_option("--seed", o.seed, "first seed");
  app.add_option("--part", o.part, "part of every range that is measured");
  app.add_option("--effect", o.effect, "hide this effect and judge what `improve` leaves (one tool)");
  app.add_option("--vernier", o.vernier, "the program");
  app.add_flag("--three-tools", o.three_tools, "rows with three tools instead of one");
  app.add_flag("-v", o.verbose, "a line for each survey");
  CLI11_PARSE(app, argc, argv);
  fmt::print("{:<14} {:>5} {:>9} {:>9} {:>9} {:>7} {:>7} {:>8} {:>8} {:>7}\n", "family", "n", "before",
             "after", "oracle", "median", "worst", "angle", "cover", "s");
  for (const std::string& name : o.families) {
    std::vector<double> ratios, angles;
    double before = 0, after = 0, oracle = 0, seconds = 0;
    std::size_t covered = 0, asked = 0, lost = 0;
    for (std::size_t i = 0; i < o.count; ++i) {
      support::SurveySpec spec;
      spec.family = support::family_named(name);
      spec.kind = o.effect.empty() ? support::SurveyClass::kNoise : support::SurveyClass::kSingle;
      spec.effect = o.effect;
      spec.rows = o.rows;
      spec.seed = o.seed + i;
      const support::HiddenSurvey survey = support::make_survey(spec);
      std::mt19937_64 random(spec.seed);
      const Outcome out = o.effect.empty() ? judge(survey, o, random) : judge_improved(survey, o);
      if (o.verbose)
        fmt::print(
            "  seed {}: before {:.2f} after {:.2f} oracle {:.2f} um, fit {:.2f} noise {:.2f}, angle {:.5f} "
            "true {:.5f} "
            "deg, "
            "cover {:.3f}, {} parameters{}, {:.2f} s\n",
            spec.seed, out.before, out.after, out.oracle, out.fit_rms, out.noise, out.angle, out.true_angle,
            static_cast<double>(out.covered) / static_cast<double>(out.asked), survey.parameters,
            out.converged ? "" : " NOT CONVERGED", out.seconds);
      ratios.push_back(out.after / out.before);
      if (out.true_angle > 0) angles.push_back(out.angle / out.true_angle);
      before += out.before / static_cast<double>(o.count);
      after += out.after / static_cast<double>(o.count);
      oracle += out.oracle / static_cast<double>(o.count);
      seconds = std::max(seconds, out.seconds);
      covered += out.covered;
      asked += out.asked;
      lost += out.converged ? 0 : 1;
    }
    std::sort(ratios.begin(), ratios.end());
    fmt::print("{:<14} {:>5} {:>9.2f} {:>9.2f} {:>9.2f} {:>7.3f} {:>7.3f} {:>8.2f} {:>8.4f} {:>7.2f}{}\n",
               name, o.count, before, after, oracle, ratios[ratios.size() / 2], ratios.back(),
               angles.empty() ? 0 : *std::max_element(angles.begin(), angles.end()),
               static_cast<double>(covered) / static_cast<double>(asked), seconds,
               lost > 0 ? fmt::format("  {} not converged", lost) : "");
    std::fflush(stdout);
  }
  return 0;
}
