// SPDX-License-Identifier: GPL-3.0-or-later
// How often `vernier diagnose` names the effect that a survey hides: surveys of known truth are written, the
// program is run on each as a user would, and its JSON is judged by the key. `diagnose_rates --help`.

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "tests/bench/diagnose/cases.h"
#include "tests/bench/diagnose/held_out.h"
#include "tests/support/hidden_survey_key.h"
#include "tests/support/hidden_survey_noise.h"
#include "tools/text/files.h"

namespace {

using namespace vernier;
using namespace vernier::text;
using namespace vernier::bench;
using namespace vernier::support;

struct Options {
  std::vector<std::string> families, effects, classes{"single"};
  std::vector<double> ratios{2};
  CaseOptions how{VERNIER_BIN_DIR "/vernier"};
  std::size_t count = 1, rows = 400, runs = 4, failures = 50;
  std::vector<int> feeds{3};
  std::uint64_t seed = 1;
  std::optional<std::uint64_t> exact_seed;
  std::optional<std::size_t> only;
  std::string noise = "white", json;
  bool held_out = false;
};

void declare(CLI::App& app, Options& o) {
  app.add_option("--family", o.families, "machine families (default: all)")->delimiter(',');
  app.add_option("--effect", o.effects, "effect ids (default: all that the family can show)")->delimiter(',');
  app.add_option("--class", o.classes, "single, two, outside, noise, confusable, or all")->delimiter(',');
  app.add_option("--ratio", o.ratios, "effect/noise, each > 0")->delimiter(',')->check(CLI::PositiveNumber);
  app.add_option("--feeds", o.feeds, "1 or 3")->delimiter(',')->check(CLI::IsMember({1, 3}));
  app.add_option("-n,--count", o.count, "surveys per cell (family x effect x ratio x feeds)");
  app.add_option("--rows", o.rows, "rows of a survey")->check(CLI::Range(20, 1000000));
  app.add_option("--runs", o.runs, "set-ups of a survey")->check(CLI::Range(1, 100));
  app.add_option("--seed", o.seed, "of the whole table");
  app.add_option("--exact-seed", o.exact_seed, "of one survey, as the list of failures names it");
  app.add_option("--case", o.only, "only this number of the list");
  app.add_option("--noise", o.noise, "law of the noise, as noise_rates names it");
  declare(app, o.how);
  app.add_option("--failures", o.failures, "how many failures to list");
  app.add_option("--json", o.json, "also write every case here");
  app.add_flag("--any", o.how.any, "of class single: also surveys whose data cannot tell");
  app.add_flag("--held-out", o.held_out,
               "add and fit what was named, compare the check rows with the truth's");
  app.add_flag("--list", o.how.only_written, "only write (--keep) and count the surveys, run nothing");
}

std::vector<Case> cells(const Options& o) {
  std::vector<std::string> classes = o.classes, families = o.families;
  if (classes == std::vector<std::string>{"all"})
    classes = {"single", "two", "outside", "noise", "confusable"};
  if (families.empty())
    for (std::size_t f = 0; f < kFamilyCount; ++f) families.emplace_back(family_name(static_cast<Family>(f)));
  std::vector<Case> cases;
  const auto add = [&](SurveySpec spec) {
    for (std::size_t i = 0; i < o.count; ++i) {
      Case one;
      one.number = cases.size();
      spec.seed = o.exact_seed ? *o.exact_seed : seed_of_case(o.seed, cases.size());
      one.spec = spec;
      cases.push_back(one);
    }
  };
  for (const std::string& kind : classes)
    for (const std::string& family : families)
      for (const double ratio : o.ratios)
        for (const int feeds : o.feeds) {
          SurveySpec spec;
          spec.kind = class_named(kind);
          spec.family = family_named(family);
          spec.ratio = ratio;
          spec.noise = noise_law_named(o.noise);
          spec.feeds = feeds;
          spec.rows = o.rows;
          spec.runs = o.runs;
          const std::vector<std::string> can = effects_of(spec.family);
          if (spec.kind != SurveyClass::kSingle) {
            add(spec);
            continue;
          }
          for (const std::string& effect : can)
            if (o.effects.empty() ||
                std::find(o.effects.begin(), o.effects.end(), effect) != o.effects.end()) {
              spec.effect = effect;
              add(spec);
            }
        }
  return cases;
}

int run(const Options& o) {
  std::vector<Case> cases = cells(o);
  if (o.only) std::erase_if(cases, [&](const Case& one) { return one.number != *o.only; });
  CaseOptions how = o.how;
  how.any = how.any || o.exact_seed.has_value();
  run_cases(cases, how,
            [&](Case& one, const HiddenSurvey& survey, const std::string& folder, const std::string&) {
              if (o.held_out && one.judgement.outcome == Outcome::kRight && !one.judgement.add.empty())
                one.held_out = held_out_ratio(survey, one.judgement.add, o.how.vernier, folder, one.trouble);
            });
  const std::vector<Case> missing = without_survey(cases);
  fmt::print("{} surveys, seed {}{}\n", cases.size(), o.seed,
             missing.empty() ? "" : fmt::format("; {} cells without a survey:", missing.size()));
  print_missing(missing);
  if (o.how.only_written)
    for (const Case& one : cases)
      fmt::print("{} {} {} {}\n", one.number, family_name(one.spec.family), class_name(one.spec.kind),
                 one.hidden);
  else
    print_rates(cases, o.failures);
  if (!o.json.empty()) write_file(o.json, cases_json(cases).dump(1) + "\n");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Recognition rates of `vernier diagnose` on surveys whose hidden effect is known.",
               "diagnose_rates");
  declare(app, options);
  CLI11_PARSE(app, argc, argv);
  try {
    return run(options);
  } catch (const std::exception& wrong) {
    fmt::print(stderr, "diagnose_rates: {}\n", wrong.what());
    return 1;
  }
}
