// SPDX-License-Identifier: GPL-3.0-or-later
// How often `vernier diagnose` names what a machine in the likeness of a real one hides (robots of published
// makes, telescopes, a probed bed, a turntable, a gear train, an arm on a torso), that it names nothing where
// nothing is hidden, and whether what `vernier compare` sees in the fitted machine is what `diagnose`
// answers. Every machine is drawn anew for its seed. `likeness_rates --help`.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>

#include "tests/bench/diagnose/cases.h"
#include "tests/bench/diagnose/process.h"
#include "tests/support/hidden_survey_family.h"

namespace {

using namespace vernier;
using namespace vernier::bench;
using namespace vernier::support;
using nlohmann::json;

struct Options {
  CaseOptions how{VERNIER_BIN_DIR "/vernier"};
  std::size_t count = 1, rows = 300, failures = 50;
  std::uint64_t seed = 1;
  double ratio = 2;
  std::vector<std::string> kinds;
  bool nothing_hidden = false;
};

/// What `compare` says of the fitted machine beside what `diagnose` says of the survey.
struct Agreement {
  std::size_t asked = 0, agreed = 0;
  std::vector<std::string> against;
};

/// A finding that chance does not make: the bound of the whole answer, over some hundred that are tried.
constexpr double kSeen = 1e-4;

/// Share of the strongest finding that what was named must take away: the rest of a cause of two parts.
constexpr double kTaken = 0.5;

struct Seen {
  std::string sentence;  // empty: nothing that chance does not make
  double rms = 0;        // um, of angles urad
};

/// The strongest finding of `compare` on a machine after a fit. Throws where a command fails.
Seen seen_after_fit(const std::string& vernier, const std::string& model, const std::string& folder) {
  const std::string csv = folder + "/survey.csv", fitted = folder + "/fit.xml";
  if (run_process({vernier, "fit", model, csv, "-o", fitted}, folder + "/fit.err").status != 0)
    throw std::runtime_error("fit failed");
  const ProcessResult run =
      run_process({vernier, "compare", fitted, csv, "--json", "-"}, folder + "/compare.err");
  if (run.status != 0) throw std::runtime_error("compare failed");
  Seen strongest;
  const json compared = json::parse(run.output);
  for (const json& finding : compared.at("findings")) {
    const double rms = finding.at("rms_um").get<double>();
    if (finding.at("p_value").get<double>() < kSeen && rms > strongest.rms)
      strongest = {finding.at("sentence").get<std::string>(), rms};
  }
  return strongest;
}

/// What was named: the steps of the ladder, else the first of those that cannot be told apart.
std::vector<std::string> named(const json& answer) {
  std::vector<std::string> adds;
  for (const json& step : answer.at("ladder"))
    if (step.at("add").is_string()) adds.push_back(step["add"]);
  if (adds.empty() && !answer.at("candidates").empty()) adds.push_back(answer["candidates"][0].at("add"));
  return adds;
}

/// Empty: they agree. Nothing seen where nothing is named; what is seen is gone, most of it, once what was
/// named is in the machine and fitted.
std::string disagreement(const std::string& vernier, const std::string& folder, const json& answer) {
  const Seen before = seen_after_fit(vernier, folder + "/model.xml", folder);
  const std::string verdict = answer.at("verdict");
  const std::string compared = ", and compare: " + (before.sentence.empty() ? "nothing" : before.sentence);
  if (verdict == "consistent") return before.sentence.empty() ? "" : verdict + compared;
  if (verdict == "unexplained" || verdict == "instrument")
    return before.sentence.empty() ? verdict + compared : "";
  if (before.sentence.empty()) return "";  // seen by what it does to all rows together
  std::string model = folder + "/model.xml";
  for (const std::string& add : named(answer)) {
    const std::string next = model == folder + "/named.xml" ? folder + "/named2.xml" : folder + "/named.xml";
    if (run_process({vernier, "add", add, model, "-o", next}, folder + "/add.err").status != 0)
      return "add failed: " + add;
    model = next;
  }
  const Seen after = seen_after_fit(vernier, model, folder);
  if (after.sentence.empty() || after.rms < kTaken * before.rms) return "";
  return verdict + compared + "; and still: " + after.sentence;
}

std::string compare_with(const std::string& vernier, const std::string& folder, const std::string& answer) {
  try {
    return disagreement(vernier, folder, json::parse(answer));
  } catch (const std::exception& wrong) {
    return wrong.what();
  }
}

std::vector<Case> cells(const Options& o) {
  std::vector<Case> cases;
  for (std::size_t k = 0; k < kLikenessCount; ++k) {
    SurveySpec spec;
    spec.family = static_cast<Family>(kFamilyCount + k);
    if (!o.kinds.empty() &&
        std::find(o.kinds.begin(), o.kinds.end(), family_name(spec.family)) == o.kinds.end())
      continue;
    spec.kind = o.nothing_hidden ? SurveyClass::kNoise : SurveyClass::kSingle;
    spec.ratio = o.ratio;
    spec.rows = o.rows;
    std::vector<std::string> effects = effects_in_likeness(spec.family);
    if (o.nothing_hidden) effects = {""};
    for (const std::string& effect : effects)
      for (std::size_t i = 0; i < o.count; ++i) {
        Case one;
        one.number = cases.size();
        spec.effect = effect;
        spec.seed = seed_of_case(o.seed, cases.size());
        one.spec = spec;
        cases.push_back(one);
      }
  }
  return cases;
}

void print_agreement(const std::map<std::string, Agreement>& by_kind, std::size_t most) {
  std::size_t asked = 0, agreed = 0;
  fmt::print("\n{:<20} {:>5}  {}\n", "compare and diagnose", "n", "agree");
  for (const auto& [kind, one] : by_kind) {
    fmt::print("{:<20} {:>5}  {}\n", kind, one.asked, share_text(one.agreed, one.asked));
    asked += one.asked;
    agreed += one.agreed;
  }
  fmt::print("{:<20} {:>5}  {}\n", "all", asked, share_text(agreed, asked));
  for (const auto& [kind, one] : by_kind)
    for (const std::string& what : one.against)
      if (most-- > 0)
        fmt::print("  {}: {}\n", kind, what);
      else
        return;
}

int run(const Options& o) {
  std::vector<Case> cases = cells(o);
  std::map<std::string, Agreement> agreement;
  std::mutex hold;
  run_cases(cases, o.how,
            [&](Case& one, const HiddenSurvey&, const std::string& folder, const std::string& answer) {
              const std::string against = compare_with(o.how.vernier, folder, answer);
              const std::lock_guard<std::mutex> held(hold);
              Agreement& kind = agreement[family_name(one.spec.family)];
              ++kind.asked;
              if (against.empty())
                ++kind.agreed;
              else
                kind.against.push_back(fmt::format("case {} ({}): {}", one.number, one.spec.effect, against));
            });
  const std::vector<Case> missing = without_survey(cases);
  fmt::print("{} surveys in the likeness of real machines, seed {}, {} without a survey\n", cases.size(),
             o.seed, missing.size());
  print_missing(missing);
  print_rates(cases, o.failures);
  print_agreement(agreement, o.failures);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  CLI::App app("Recognition rates of `vernier diagnose` on machines in the likeness of real ones.",
               "likeness_rates");
  app.add_option("--kind", o.kinds, "six-joint, alt-az, equatorial, bed, turntable, gear-train, torso-arm")
      ->delimiter(',');
  app.add_option("-n,--count", o.count, "surveys of each kind and effect");
  app.add_option("--rows", o.rows, "rows of a survey")->check(CLI::Range(20, 1000000));
  app.add_option("--ratio", o.ratio, "effect/noise")->check(CLI::PositiveNumber);
  app.add_option("--seed", o.seed, "of the whole table");
  app.add_flag("--nothing-hidden", o.nothing_hidden, "surveys that hide nothing: any name is false");
  declare(app, o.how);
  app.add_option("--failures", o.failures, "how many failures to list");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(o);
  } catch (const std::exception& wrong) {
    fmt::print(stderr, "likeness_rates: {}\n", wrong.what());
    return 1;
  }
}
