// SPDX-License-Identifier: GPL-3.0-or-later
// Parts on machines that were surveyed with nothing hidden and fitted: do 95 % of the true values lie in the
// intervals, are the verdicts right, and is the source that is named the one whose absence in the true
// machine helps most?
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "tests/support/hidden_survey.h"
#include "tests/support/hidden_survey_family.h"
#include "tools/effects/catalogue.h"
#include "tools/fit/fit.h"
#include "tools/kinematics/inverse.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"
#include "tools/offline/corrector.h"
#include "tools/text/error.h"
#include "tools/tolerance/conformity.h"
#include "tools/tolerance/machine_sources.h"

namespace {

using namespace vernier;
using namespace vernier::effects;
using namespace vernier::fit;
using namespace vernier::kinematics;
using namespace vernier::model;
using namespace vernier::offline;
using namespace vernier::text;
using namespace vernier::tolerance;
using Random = std::mt19937_64;

constexpr double kNothing_mm = 1e-6;  // an interval's ends are told to a nanometre

double between(double low, double high, Random& random) {
  return low + (high - low) * static_cast<double>(random() >> 11U) * 0x1p-53;
}

/// Hits and tries by name.
struct Count {
  std::size_t hits = 0, tries = 0;
  void take(bool hit) {
    hits += hit ? 1 : 0;
    ++tries;
  }
  double share() const {
    return static_cast<double>(hits) / static_cast<double>(std::max<std::size_t>(1, tries));
  }
};

struct Figures {
  std::map<std::string, Count> off, on;  // covered, by characteristic
  Count said_conforms, said_does_not;    // right ones of each
  std::size_t not_said = 0;
  Count first;  // the source that the fitted value would fall by most without: right
  Count named,
      told;  // of the characteristics with one dominant source: right; of all: the true one is listed
  std::size_t asked = 0;
  std::size_t parts = 0;
};

void add(Figures& all, const Figures& one) {
  const auto sum = [](Count& a, const Count& b) { a.hits += b.hits, a.tries += b.tries; };
  for (const auto& [name, count] : one.off) sum(all.off[name], count);
  for (const auto& [name, count] : one.on) sum(all.on[name], count);
  sum(all.said_conforms, one.said_conforms);
  sum(all.said_does_not, one.said_does_not);
  sum(all.first, one.first);
  sum(all.named, one.named);
  sum(all.told, one.told);
  all.not_said += one.not_said;
  all.asked += one.asked;
  all.parts += one.parts;
}

States resting(const Machine& machine, const support::Geometry& g, Random& random) {
  std::vector<double> references;
  for (const Input& input : machine.inputs) {
    double value = input.reference;
    for (const auto& [name, held] : g.held)
      if (input.name == name) value = held;
    references.push_back(value);
  }
  States at = make_states(1, machine.axes.size(), references);
  for (std::size_t i = 0; i < g.axes.size(); ++i) {
    const double middle = (g.axes[i].low + g.axes[i].high) / 2, half = (g.axes[i].high - g.axes[i].low) / 2;
    at.axis[i][0] = middle + 0.5 * half * between(-1, 1, random);
  }
  return at;
}

/// A plate with a datum plane, three bores (one or two of them datums), two points. A tolerance is about as
/// wide as the machine is off, so that verdicts are not foregone.
PartDrawing drawn_part(const Eigen::Vector3d& at, double size_mm, double off_mm, Random& random) {
  PartDrawing part{"drawn", {}};
  const auto place = [&](double height) {
    return Eigen::Vector3d(at + Eigen::Vector3d(between(-1, 1, random) * size_mm / 2,
                                                between(-1, 1, random) * size_mm / 2, height * size_mm));
  };
  const auto zone = [&]() { return off_mm * std::exp(between(-3.5, 0, random)); };
  PartFeature plane;
  plane.name = "plane";
  plane.kind = PartFeatureKind::kPlane;
  plane.at = at;
  plane.direction = Eigen::Vector3d::UnitZ();
  plane.length_mm = size_mm;
  plane.width_mm = between(0.4, 1, random) * size_mm;
  plane.form_mm = zone();
  plane.datum = true;
  part.features.push_back(plane);
  for (int i = 0; i < 3; ++i) {
    PartFeature bore;
    bore.name = fmt::format("bore {}", i + 1);
    bore.kind = PartFeatureKind::kCylinder;
    bore.at = place(-0.05);
    bore.direction = i < 2 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
    bore.diameter_mm = between(0.05, 0.3, random) * size_mm;
    bore.length_mm = between(0, 1, random) < 0.3 ? 0 : between(0.05, 0.2, random) * size_mm;
    bore.position_mm = zone();
    bore.form_mm = zone();
    bore.size_mm = {-zone(), zone()};
    bore.datum = i == 0 || (i == 1 && between(0, 1, random) < 0.5);
    if (bore.datum) bore.position_mm.reset();
    part.features.push_back(bore);
  }
  for (int i = 0; i < 2; ++i) {
    PartFeature point;
    point.name = fmt::format("point {}", i + 1);
    point.at = place(i == 0 ? 0.1 : -0.1);
    if (i == 1) point.direction = Eigen::Vector3d::UnitY();
    point.position_mm = zone();
    part.features.push_back(point);
  }
  for (std::size_t i = 0; i < part.features.size(); ++i) part.features[i].line = i + 2;
  return part;
}

Eigen::VectorXd rows_of(const Machine& machine, const States& states, const PlacedPart& part,
                        const PartValues& values) {
  const Eigen::Matrix3Xd off = forward(machine, states).position - part.point;
  return values.map * off.reshaped();
}

/// The source without which the true machine's value would fall most; none where that is below a nanometre.
std::vector<std::string> true_dominant(const Machine& truth, const PlacedPart& part, const PartValues& values,
                                       const std::vector<Effect>& catalogue) {
  const Eigen::VectorXd all = rows_of(truth, part.states, part, values);
  std::vector<std::string> best(values.values.size());
  std::vector<double> most(values.values.size(), -1e300);
  for (const MachineSource& source : machine_sources(truth, ParameterSet(truth, {}), catalogue)) {
    const Eigen::VectorXd without = rows_of(without_source(truth, source), part.states, part, values);
    for (std::size_t v = 0; v < values.values.size(); ++v) {
      const double fall = std::abs(values.values[v].of(all)) - std::abs(values.values[v].of(without));
      if (fall > kNothing_mm && fall > most[v]) most[v] = fall, best[v] = source.name;
    }
  }
  return best;
}

Figures judge(const Machine& truth, const Machine& fitted, const PlacedPart& part, const PartDrawing& drawn,
              const std::vector<Effect>& catalogue, std::uint64_t seed) {
  Figures figures;
  figures.parts = 1;
  ConformityOptions options;
  options.seed = seed;
  options.most_trials = 20000;
  const PartConformity said = part_conformity(fitted, part, drawn.file, catalogue, options);
  const PartValues values = part_values(part, PartFrame::kPart, drawn.file);
  Corrector corrector(fitted, {.with_rotary = linear_axes(fitted).empty(), .back = false});
  const Eigen::MatrixXd commands = corrector.commands(part.states);
  States corrected = part.states;
  for (std::size_t a = 0; a < fitted.axes.size(); ++a)
    corrected.axis[a] = commands.row(static_cast<Eigen::Index>(a)).transpose().array();
  const Eigen::VectorXd off = rows_of(truth, part.states, part, values),
                        on = rows_of(truth, corrected, part, values);
  const std::vector<std::string> dominant = true_dominant(truth, part, values, catalogue);
  for (std::size_t v = 0; v < values.values.size(); ++v) {
    const CharacteristicValue& value = values.values[v];
    const CharacteristicResult& one = said.characteristics[v];
    const auto covered = [&](const Expectation& e, double real) {
      return real >= e.low - kNothing_mm && real <= e.high + kNothing_mm;
    };
    figures.off[characteristic_name(one.what)].take(covered(one.off, value.of(off)));
    figures.on[characteristic_name(one.what)].take(covered(one.on, value.of(on)));
    if (one.off.verdict) {
      const double real = value.of(off);
      const bool conforms = real >= (*one.limits_mm)[0] && real <= (*one.limits_mm)[1];
      if (*one.off.verdict == PartVerdict::kConforms) figures.said_conforms.take(conforms);
      if (*one.off.verdict == PartVerdict::kDoesNotConform) figures.said_does_not.take(!conforms);
      figures.not_said += *one.off.verdict == PartVerdict::kCannotBeSaid ? 1 : 0;
    }
    if (dominant[v].empty()) continue;
    ++figures.asked;
    figures.told.take(std::find(one.dominant.begin(), one.dominant.end(), dominant[v]) != one.dominant.end());
    figures.first.take(!one.sources.empty() && one.sources[0].name == dominant[v]);
    if (one.dominant.size() == 1) figures.named.take(one.dominant[0] == dominant[v]);
  }
  return figures;
}

void print(const std::string& name, const Figures& f) {
  const auto share = [](const std::map<std::string, Count>& all, const std::string& what) {
    const auto found = all.find(what);
    return found == all.end() || found->second.tries == 0
               ? std::string("-")
               : fmt::format("{:.1f}", 100 * found->second.share());
  };
  Count off, on;
  for (const auto& [what, count] : f.off) off.hits += count.hits, off.tries += count.tries;
  for (const auto& [what, count] : f.on) on.hits += count.hits, on.tries += count.tries;
  fmt::print(
      "{:<10} {:>5} {:>6} | {:>6.2f} {:>6} {:>6} {:>6} | {:>6.2f} {:>6} {:>6} {:>6} | {:>6.1f} {:>6.1f} "
      "{:>5.1f} "
      "| {:>6.1f} {:>6.1f} {:>6.1f} {:>6.1f}\n",
      name, f.parts, f.asked, 100 * off.share(), share(f.off, "position"), share(f.off, "size"),
      share(f.off, "form"), 100 * on.share(), share(f.on, "position"), share(f.on, "size"),
      share(f.on, "form"), 100 * f.said_conforms.share(), 100 * f.said_does_not.share(),
      100 * static_cast<double>(f.not_said) /
          static_cast<double>(
              std::max<std::size_t>(1, f.not_said + f.said_conforms.tries + f.said_does_not.tries)),
      100 * f.named.share(), 100 * static_cast<double>(f.named.tries) / static_cast<double>(f.asked),
      100 * f.told.share(), 100 * f.first.share());
  std::fflush(stdout);
}

/// The truth with an error in x, y and z that no model of the bench has: a wave of 1 to 2 um of a screw's
/// pitch along X, or smooth errors of some stations' length along all three axes. For chains of linear axes.
Machine with_lack(const std::string& text, const std::string& lack, double u_um, Random& random) {
  const auto wave = [&](const char* axis, double size_um, double length_mm) {
    return fmt::format("{:.7f}*sin(360*{}/{:.3f}+{:.1f})", 1e-3 * size_um * u_um, axis, length_mm,
                       between(0, 360, random));
  };
  std::string x = "0", y = "0", z = "0";
  if (lack == "wave") {
    x = wave("X", between(1, 2, random), between(4, 12, random));
  } else {
    for (const char* axis : {"X", "Y", "Z"})
      for (std::string* along : {&x, &y, &z})
        *along += "+" + wave(axis, between(0.5, 1.5, random), between(60, 160, random));
  }
  const std::size_t at = text.find("</transforms>", text.find("branch=\"tool\""));
  const std::string row = fmt::format("<sixdof X=\"{}\" Y=\"{}\" Z=\"{}\"/>", x, y, z);
  return parse_machine(text.substr(0, at) + row + text.substr(at), "truth.xml");
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> families = {"bridge", "column", "gantry", "five-axis", "robot"};
  std::size_t machines = 20, parts = 10, rows = 300;
  std::uint64_t seed = 1;
  std::string lack;
  CLI::App app{"Parts on fitted machines against the true machines"};
  app.add_option("--family", families, "bridge column gantry horizontal-arm five-axis fibre robot");
  app.add_option("-n", machines, "machines of each family");
  app.add_option("--parts", parts, "parts on each machine");
  app.add_option("--rows", rows, "rows of a survey");
  app.add_option("--seed", seed, "first seed");
  app.add_option("--lack", lack, "what the model lacks: wave or smooth; default: nothing")
      ->check(CLI::IsMember({"wave", "smooth"}));
  CLI11_PARSE(app, argc, argv);
  fmt::print(
      "seed {}; covered of 95 % intervals without | with correction; verdicts right | not said; dominant "
      "source right where one is named, named, listed, first; all in %\n{:<10} {:>5} {:>6} | {:>6} {:>6} "
      "{:>6} "
      "{:>6} | "
      "{:>6} {:>6} {:>6} {:>6} | {:>6} {:>6} {:>5} | {:>6} {:>6} {:>6} {:>6}\n",
      seed, "family", "parts", "values", "all", "posit.", "size", "form", "all", "posit.", "size", "form",
      "yes", "no", "?", "right", "named", "listed", "first");
  const std::vector<Effect>& catalogue = built_in_effects();
  Figures all;
  for (const std::string& name : families) {
    Figures figures;
    const support::Family family = support::family_named(name);
    const support::Geometry g = support::geometry_of(family);
    for (std::size_t i = 0; i < machines; ++i) {
      support::SurveySpec spec;
      spec.family = family;
      spec.kind = support::SurveyClass::kNoise;
      spec.rows = rows;
      spec.seed = seed + i;
      const support::HiddenSurvey survey = support::make_survey(spec);
      Random random(spec.seed * 7919 + 13);
      Machine truth = parse_machine(survey.truth, "truth.xml");
      const Machine model = parse_machine(survey.model, "model.xml");
      Measurement m = parse_measurement(survey.csv, "survey.csv", model);
      if (!lack.empty()) {
        const Measurement of_truth = parse_measurement(survey.csv, "survey.csv", truth);
        const Machine lacking = with_lack(survey.truth, lack, 1e3 * g.u_mm, random);
        const Eigen::VectorXd more = predict(lacking, of_truth) - predict(truth, of_truth);
        for (std::size_t k = 0; k < m.observations.size(); ++k)
          m.observations[k].value += more[static_cast<Eigen::Index>(k)];
        truth = lacking;
      }
      const Machine fitted = fit::fit(model, m).machine;
      for (std::size_t p = 0, tries = 0; p < parts && tries < 20 * parts; ++tries) {
        const States at = resting(fitted, g, random);
        double size = 1e300;
        for (const auto& axis : g.axes)
          if (!axis.rotary) size = std::min(size, 0.3 * (axis.high - axis.low));
        if (size > 1e6) size = 150;
        const Eigen::Matrix3Xd centre = forward(nominal_machine(fitted), at).position;
        const double off_mm = std::max(1e-4, deviation(truth, at).norm() / 2);
        const PartDrawing part = drawn_part(centre.col(0), size, off_mm, random);
        try {
          const PlacedPart placed = place_part(fitted, part, at);
          add(figures, judge(truth, fitted, placed, part, catalogue, random()));
          ++p;
        } catch (const LimitNotMet&) {
          // Out of reach: another one.
        }
      }
    }
    print(name, figures);
    add(all, figures);
  }
  print("all", all);
  return 0;
}
