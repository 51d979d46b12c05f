// SPDX-License-Identifier: GPL-3.0-or-later
// How often `vernier diagnose` names the effect that a survey hides: surveys of known truth are written, the
// program is run on each as a user would, and its JSON is judged by the key. `diagnose_rates --help`.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <filesystem>
#include <mutex>
#include <thread>

#include "tests/bench/diagnose/held_out.h"
#include "tests/bench/diagnose/process.h"
#include "tests/bench/diagnose/rates.h"
#include "tests/support/hidden_survey_key.h"
#include "tools/text/files.h"

namespace {

using namespace vernier;
using namespace vernier::text;
using namespace vernier::bench;
using namespace vernier::support;

struct Options {
  std::vector<std::string> families, effects, classes{"single"};
  std::vector<double> ratios{2};
  std::size_t count = 1, rows = 400, runs = 4, jobs = 2, failures = 50;
  std::vector<int> feeds{3};
  std::uint64_t seed = 1;
  std::optional<std::uint64_t> exact_seed;
  std::optional<std::size_t> only;
  std::string keep, scratch, vernier = VERNIER_BIN_DIR "/vernier", json;
  bool any = false, held_out = false, list = false;
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
  app.add_option("--keep", o.keep, "write the surveys here, a folder each, and keep them");
  app.add_option("-j,--jobs", o.jobs, "diagnoses at the same time")->check(CLI::Range(1, 64));
  app.add_option("--vernier", o.vernier, "program to judge");
  app.add_option("--scratch", o.scratch, "folder for files in between");
  app.add_option("--failures", o.failures, "how many failures to list");
  app.add_option("--json", o.json, "also write every case here");
  app.add_flag("--any", o.any, "of class single: also surveys whose data cannot tell");
  app.add_flag("--held-out", o.held_out,
               "add and fit what was named, compare the check rows with the truth's");
  app.add_flag("--list", o.list, "only write (--keep) and count the surveys, run nothing");
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
      spec.seed = o.exact_seed ? *o.exact_seed : (o.seed * 1000003 + cases.size()) * 64;
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

/// The survey of a case: the first of up to 40 seeds whose data can tell, where that is asked for.
std::optional<HiddenSurvey> survey_of(Case& one, const Options& o) {
  const bool must_tell = !o.any && !o.exact_seed && one.spec.kind != SurveyClass::kNoise &&
                         one.spec.kind != SurveyClass::kConfusable;
  for (int k = 0; k < (must_tell ? 40 : 1); ++k, ++one.spec.seed) {
    HiddenSurvey survey = make_survey(one.spec);
    if (must_tell && !survey.can_tell) continue;
    one.can_tell = survey.can_tell;
    for (const HiddenEffect& e : survey.effects)
      one.hidden += fmt::format("{}{} axis={} input={} {}", one.hidden.empty() ? "" : " + ", e.cause.effect,
                                e.cause.axis, e.cause.input, e.term);
    return survey;
  }
  one.trouble = "no survey whose data can tell in 40 seeds";
  return {};
}

void write(const HiddenSurvey& survey, const std::string& folder) {
  std::filesystem::create_directories(folder);
  write_file(folder + "/model.xml", survey.model);
  write_file(folder + "/survey.csv", survey.csv);
  write_file(folder + "/key.json", key_of(survey));
  write_file(folder + "/truth.xml", survey.truth);
}

void diagnose(Case& one, const HiddenSurvey& survey, const Options& o, const std::string& folder) {
  const ProcessResult run =
      run_process({o.vernier, "diagnose", folder + "/model.xml", folder + "/survey.csv", "--json", "-"},
                  folder + "/diagnose.err");
  one.seconds = run.seconds;
  if (!o.keep.empty()) write_file(folder + "/answer.json", run.output);
  if (run.status != 0) {
    one.judgement.said =
        fmt::format("exit status {}: {}", run.status, read_file(folder + "/diagnose.err").substr(0, 200));
    return;
  }
  one.judgement = judge(survey, run.output);
  if (o.held_out && one.judgement.outcome == Outcome::kRight && !one.judgement.add.empty())
    one.held_out = held_out_ratio(survey, one.judgement.add, o.vernier, folder, one.trouble);
}

void treat(Case& one, const Options& o, const std::string& scratch) {
  const std::string folder = fmt::format("{}/case{}", o.keep.empty() ? scratch : o.keep, one.number);
  try {
    const std::optional<HiddenSurvey> survey = survey_of(one, o);
    if (!survey) return;
    write(*survey, folder);
    if (!o.list) diagnose(one, *survey, o, folder);
  } catch (const std::exception& wrong) {
    one.trouble = wrong.what();
  }
  if (o.keep.empty()) std::filesystem::remove_all(folder);
}

void run_all(std::vector<Case>& cases, const Options& o, const std::string& scratch) {
  std::atomic<std::size_t> next = 0, done = 0;
  std::mutex print;
  const auto work = [&] {
    for (std::size_t i = 0; (i = next++) < cases.size();) {
      treat(cases[i], o, scratch);
      const std::size_t so_far = ++done;
      if (so_far % 20 != 0 && so_far != cases.size()) continue;
      const std::lock_guard<std::mutex> hold(print);
      fmt::print(stderr, "\r{} of {}", so_far, cases.size());
    }
  };
  std::vector<std::thread> workers;
  for (std::size_t j = 0; j < o.jobs; ++j) workers.emplace_back(work);
  for (std::thread& worker : workers) worker.join();
  fmt::print(stderr, "\n");
}

void write_json(const std::vector<Case>& cases, const std::string& path) {
  nlohmann::json list = nlohmann::json::array();
  for (const Case& one : cases)
    list.push_back({{"case", one.number},
                    {"seed", one.spec.seed},
                    {"family", family_name(one.spec.family)},
                    {"class", class_name(one.spec.kind)},
                    {"effect", one.spec.effect},
                    {"ratio", one.spec.ratio},
                    {"feeds", one.spec.feeds},
                    {"can_tell", one.can_tell},
                    {"hidden", one.hidden},
                    {"outcome", outcome_name(one.judgement.outcome)},
                    {"said", one.judgement.said},
                    {"seconds", one.seconds},
                    {"trouble", one.trouble},
                    {"held_out_ratio", one.held_out ? nlohmann::json(*one.held_out) : nlohmann::json()}});
  write_file(path, list.dump(1) + "\n");
}

/// Surveys that could not be made are no verdict on the diagnosis: listed, not counted.
std::vector<Case> without_survey(std::vector<Case>& cases) {
  std::vector<Case> missing;
  std::erase_if(cases, [&](const Case& one) {
    const bool none = one.hidden.empty() && one.spec.kind != SurveyClass::kNoise;
    if (none) missing.push_back(one);
    return none;
  });
  return missing;
}

int run(const Options& o) {
  std::vector<Case> cases = cells(o);
  if (o.only) std::erase_if(cases, [&](const Case& one) { return one.number != *o.only; });
  if (!o.list && !std::filesystem::exists(o.vernier)) {
    fmt::print(stderr, "{}: no such program\n", o.vernier);
    return 1;
  }
  const std::string base = o.scratch.empty() ? std::filesystem::temp_directory_path().string() : o.scratch;
  std::string scratch = base + "/diagnose_rates_XXXXXX";
  if (mkdtemp(scratch.data()) == nullptr) throw std::runtime_error(scratch + ": cannot be made");
  run_all(cases, o, scratch);
  std::filesystem::remove_all(scratch);
  const std::vector<Case> missing = without_survey(cases);
  fmt::print("{} surveys, seed {}{}\n", cases.size(), o.seed,
             missing.empty() ? "" : fmt::format("; {} cells without a survey:", missing.size()));
  for (const Case& one : missing)
    fmt::print("  {} {} ratio {:g}: {}\n", family_name(one.spec.family), one.spec.effect, one.spec.ratio,
               one.trouble);
  if (o.list)
    for (const Case& one : cases)
      fmt::print("{} {} {} {}\n", one.number, family_name(one.spec.family), class_name(one.spec.kind),
                 one.hidden);
  else
    print_rates(cases, o.failures);
  if (!o.json.empty()) write_json(cases, o.json);
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
