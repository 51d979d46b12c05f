// SPDX-License-Identifier: GPL-3.0-or-later
// What `vernier diagnose` says where the noise is not white: surveys of known truth under each law of noise,
// with nothing hidden and with one effect, and disturbances of the instrument; beside it one who knows the
// law (oracle.h), and whether the parameters' std is what their errors are. `noise_rates --help`.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <map>
#include <mutex>

#include "tests/bench/diagnose/cases.h"
#include "tests/bench/diagnose/oracle.h"
#include "tests/support/hidden_survey_key.h"
#include "tests/support/hidden_survey_noise.h"
#include "tools/text/files.h"

namespace {

using namespace vernier::bench;
using namespace vernier::support;

struct Options {
  CaseOptions how{VERNIER_BIN_DIR "/vernier"};
  std::vector<std::string> laws, families;
  std::vector<double> ratios{2, 1};
  std::size_t count = 1, rows = 400, runs = 4, failures = 50;
  std::uint64_t seed = 1;
  std::string json;
  bool without_oracle = false, without_nothing = false;
};

/// What is known of a case beside the judgement.
struct Beside {
  std::optional<OracleAnswer> oracle;
  std::vector<double> errors;
};
using AllBeside = std::map<std::size_t, Beside>;

std::vector<Case> cells(const Options& o) {
  std::vector<std::string> laws = o.laws;
  for (std::size_t i = 0; o.laws.empty() && i < kNoiseLaws; ++i)
    laws.emplace_back(noise_law_name(static_cast<NoiseLaw>(i)));
  std::vector<Family> families;
  for (const std::string& name : o.families) families.push_back(family_named(name));
  for (std::size_t f = 0; o.families.empty() && f < kFamilyCount; ++f)
    families.push_back(static_cast<Family>(f));
  std::vector<Case> cases;
  for (const std::string& law : laws) {
    SurveySpec spec;
    spec.noise = noise_law_named(law);
    spec.rows = o.rows;
    spec.runs = o.runs;
    std::vector<double> ratios = spec.noise < NoiseLaw::kDrift ? o.ratios : std::vector<double>();
    if (!o.without_nothing || ratios.empty()) ratios.push_back(0);
    for (const double ratio : ratios)
      for (std::size_t i = 0; i < o.count; ++i) {
        Case one;
        one.number = cases.size();
        one.spec = spec;
        one.spec.kind = ratio > 0 ? SurveyClass::kSingle : SurveyClass::kNoise;
        if (ratio > 0) one.spec.ratio = ratio;
        one.spec.family = families[(cases.size() + o.seed) % families.size()];
        one.spec.seed = seed_of_case(o.seed, cases.size());
        // Named, so that a failure can be made again; all in turn.
        const std::vector<std::string> effects = effects_of(one.spec.family);
        if (ratio > 0)
          one.spec.effect =
              effects[(cases.size() / families.size() + 5 * cases.size() + o.seed) % effects.size()];
        cases.push_back(one);
      }
  }
  return cases;
}

bool is_named(Outcome outcome) { return outcome == Outcome::kWrong || outcome == Outcome::kCustom; }

/// One law and ratio: "12 of 20" beside its interval.
void print_cell(const std::string& name, const std::vector<const Case*>& cases, const AllBeside& beside) {
  Tally tally;
  std::size_t oracle_right = 0, oracle_named = 0, asked = 0, both = 0;
  for (const Case* one : cases) {
    ++tally.count[static_cast<std::size_t>(one->judgement.outcome)];
    const auto found = beside.find(one->number);
    if (found == beside.end() || !found->second.oracle) continue;
    ++asked;
    oracle_right += found->second.oracle->right ? 1 : 0;
    oracle_named += found->second.oracle->named ? 1 : 0;
    both += found->second.oracle->right && one->judgement.outcome == Outcome::kRight ? 1 : 0;
  }
  const std::size_t open =
      tally[Outcome::kAmbiguous] + tally[Outcome::kAmbiguousMiss] + tally[Outcome::kCustom];
  const std::size_t wrong = tally[Outcome::kWrong], all = cases.size();
  const SurveySpec& spec = cases.front()->spec;
  if (spec.kind == SurveyClass::kSingle) {
    fmt::print(
        "{:<22} {:>4}  right {:<24} wrong {:<22} open {} unexplained {} instrument {} consistent {} error {}",
        name, all, share_text(tally[Outcome::kRight], all), share_text(wrong, all), open,
        tally[Outcome::kUnexplained], tally[Outcome::kInstrument], tally[Outcome::kConsistent],
        tally[Outcome::kError]);
    if (asked > 0) fmt::print("; oracle {} of {}, both {}", oracle_right, asked, both);
  } else {
    fmt::print(
        "{:<22} {:>4}  falsely named {:<22} instrument {:<24} consistent {} open {} unexplained {} error {}",
        name, all, share_text(wrong, all), share_text(tally[Outcome::kInstrument], all),
        tally[Outcome::kRight], open, tally[Outcome::kUnexplained], tally[Outcome::kError]);
    if (asked > 0) fmt::print("; oracle names {} of {}", oracle_named, asked);
  }
  fmt::print("\n");
}

/// rms of the errors of a law's parameters over their std, its standard error from survey to survey.
void print_errors(const std::vector<Case>& cases, const AllBeside& beside) {
  std::map<std::size_t, std::vector<double>> of_law;  // mean squares of the surveys
  for (const Case& one : cases) {
    const auto found = beside.find(one.number);
    if (found == beside.end() || found->second.errors.empty()) continue;
    double squares = 0;
    for (const double error : found->second.errors) squares += error * error;
    of_law[static_cast<std::size_t>(one.spec.noise)].push_back(
        squares / static_cast<double>(found->second.errors.size()));
  }
  fmt::print("\nrms of (estimate - truth) / std, of parameters from data, the true model fitted\n");
  for (const auto& [law, surveys] : of_law) {
    double mean = 0, spread = 0;
    const auto n = static_cast<double>(surveys.size());
    for (const double one : surveys) mean += one / n;
    for (const double one : surveys) spread += (one - mean) * (one - mean);
    const double error = n > 1 ? std::sqrt(spread / (n - 1) / n) : 0;
    fmt::print("{:<22} {:>4}  {:.3f} +- {:.3f}\n", noise_law_name(static_cast<NoiseLaw>(law)), surveys.size(),
               std::sqrt(mean), error / (2 * std::sqrt(mean)));
  }
}

void print_failures(const std::vector<Case>& cases, const AllBeside& beside, std::size_t most) {
  for (const Case& one : cases) {
    const Outcome outcome = one.judgement.outcome;
    const bool disturbed = one.spec.noise >= NoiseLaw::kDrift;
    if (disturbed ? outcome == Outcome::kInstrument : outcome == Outcome::kRight) continue;
    if (one.spec.kind == SurveyClass::kNoise && !disturbed && !is_named(outcome) &&
        outcome != Outcome::kError)
      continue;
    if (most-- == 0) return;
    const auto found = beside.find(one.number);
    const bool knows = found != beside.end() && found->second.oracle && found->second.oracle->right;
    fmt::print("case {} {} {} -> {}{}\n  hidden: {}\n  said:   {}\n  {}\n", one.number,
               noise_law_name(one.spec.noise), family_name(one.spec.family), outcome_name(outcome),
               knows ? ", the oracle is right" : "", one.hidden, one.judgement.said, again(one));
    if (!one.trouble.empty()) fmt::print("  trouble: {}\n", one.trouble);
  }
}

int run(const Options& o) {
  std::vector<Case> cases = cells(o);
  AllBeside beside;
  std::mutex hold;
  run_cases(cases, o.how, [&](Case& one, const HiddenSurvey& survey, const std::string&, const std::string&) {
    if (o.without_oracle || one.spec.noise >= NoiseLaw::kDrift) return;
    Beside known;
    try {
      known.oracle = ask_oracle(survey);
      known.errors = parameter_errors(survey);
    } catch (const std::exception& wrong) {
      one.trouble = wrong.what();
    }
    const std::lock_guard<std::mutex> held(hold);
    beside[one.number] = std::move(known);
  });
  const std::vector<Case> missing = without_survey(cases);
  fmt::print("{} surveys, seed {}, {} rows, {} without a survey\n", cases.size(), o.seed, o.rows,
             missing.size());
  print_missing(missing);
  std::map<std::pair<std::size_t, double>, std::vector<const Case*>> groups;
  for (const Case& one : cases)
    groups[{static_cast<std::size_t>(one.spec.noise),
            one.spec.kind == SurveyClass::kSingle ? -one.spec.ratio : 0}]
        .push_back(&one);
  for (const auto& [key, group] : groups)
    print_cell(fmt::format("{} {}", noise_law_name(static_cast<NoiseLaw>(key.first)),
                           key.second < 0 ? fmt::format("{:g}", -key.second) : "nothing"),
               group, beside);
  print_errors(cases, beside);
  fmt::print("\n");
  print_failures(cases, beside, o.failures);
  if (!o.json.empty()) vernier::text::write_file(o.json, cases_json(cases).dump(1) + "\n");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  CLI::App app("What `vernier diagnose` says under laws of noise that are not white.", "noise_rates");
  app.add_option(
         "--noise", o.laws,
         "white, student, quantised, no-u, twice-u, outliers, set-ups, autoregressive, walk, walk-no-u, "
         "poses, growing-u; drift, step, jump of the instrument (default: all)")
      ->delimiter(',');
  app.add_option("--family", o.families, "machine families, one after the other (default: all)")
      ->delimiter(',');
  app.add_option("--ratio", o.ratios, "effect over the whole standard deviation of the noise")
      ->delimiter(',')
      ->check(CLI::PositiveNumber);
  app.add_option("-n,--count", o.count, "surveys of each law and ratio, and with nothing hidden");
  app.add_option("--rows", o.rows, "rows of a survey")->check(CLI::Range(20, 1000000));
  app.add_option("--runs", o.runs, "set-ups of a survey")->check(CLI::Range(1, 100));
  app.add_option("--seed", o.seed, "of the whole table");
  app.add_option("--failures", o.failures, "how many failures to list");
  app.add_option("--json", o.json, "also write every case here");
  app.add_flag("--without-oracle", o.without_oracle, "neither oracle nor errors of parameters");
  app.add_flag("--only-hidden", o.without_nothing, "not with nothing hidden");
  declare(app, o.how);
  CLI11_PARSE(app, argc, argv);
  try {
    return run(o);
  } catch (const std::exception& wrong) {
    fmt::print(stderr, "noise_rates: {}\n", wrong.what());
    return 1;
  }
}
