// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cmath>
#include <mutex>
#include <thread>
#include <type_traits>

#include "tests/bench/diagnose/rates.h"
#include "tests/support/hidden_survey_key.h"
#include "tools/diagnose/diagnosis.h"
#include "tools/diagnose/sentences.h"
#include "tools/model/machine_reader.h"
#include "tools/results/diagnosis_json.h"

namespace vernier::bench {

using namespace vernier::diagnose;
using namespace vernier::model;
using namespace vernier::results;
namespace {

using support::Family;
using support::HiddenSurvey;
using support::SurveyClass;
using support::SurveySpec;

struct SweepOptions {
  std::vector<std::string> families = {"single-axis", "ball-bar"}, only,
                           classes = {"single", "two", "outside", "noise", "confusable"};
  std::size_t count = 2, rows = 120, jobs = 2;
  std::uint64_t seed = 1;
  double by = 2;
  bool search = false;  // the numbers of the search extent instead of the levels
};

/// A survey with what is needed to diagnose it again and again.
struct Subject {
  HiddenSurvey survey;
  Machine machine;
  Measurement rows;
};

/// What a user is told, and whether that is as asked.
struct Told {
  std::string verdict, names;
  bool good = false, wrong = false;
};

/// One level, or number of the search extent, at one factor, over all surveys.
struct Change {
  std::string name;
  double factor = 1, value = 0;
  std::size_t verdicts = 0, names = 0, lost = 0, gained = 0, wrong = 0;
  bool any() const { return verdicts + names > 0; }
};

DiagnoseThresholds changed(const std::string& name, double factor, double* value = nullptr) {
  fit::Levels levels;
  SearchExtent search;
  const auto change = [&](const std::string& each, auto& number) {
    if (each != name) return;
    const double scaled = factor * static_cast<double>(number);
    if constexpr (std::is_integral_v<std::decay_t<decltype(number)>>)
      number = static_cast<std::size_t>(std::max(1L, std::lround(scaled)));
    else
      // A share of a whole of more than 1 would switch off what it decides.
      number = number < 1 && number > 0 ? std::min(scaled, 0.5 * (1 + number)) : scaled;
    if (value != nullptr) *value = static_cast<double>(number);
  };
  levels.for_each(change);
  search.for_each(change);
  return {levels, search};
}

std::vector<std::string> names_of(bool search) {
  std::vector<std::string> list;
  const auto take = [&](const std::string& name, auto&) { list.push_back(name); };
  if (search)
    SearchExtent().for_each(take);
  else
    fit::Levels().for_each(take);
  return list;
}

Told told(const Subject& subject, const DiagnoseThresholds& thresholds) {
  DiagnoseOptions options;
  options.thresholds = thresholds;
  options.shown = 3;  // enough to see who is confounded with whom; each more is a fit
  Told result;
  try {
    const Diagnosis diagnosis =
        diagnose::diagnose(subject.survey.model, subject.machine, subject.rows, options);
    result.verdict = verdict_name(diagnosis.verdict);
    for (const LadderStep& step : diagnosis.ladder) result.names += step.label + "; ";
    Case one;
    one.spec = subject.survey.spec;
    one.can_tell = subject.survey.can_tell;
    one.judgement = judge(subject.survey, diagnosis_json(diagnosis, subject.rows).dump());
    result.good = is_good(one);
    result.wrong = is_wrong_name(one);
  } catch (const std::exception& error) {
    result.verdict = std::string("error: ") + error.what();
  }
  return result;
}

/// Calls work(i) for every i below `count`, `jobs` at a time.
void in_parallel(std::size_t count, std::size_t jobs, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::vector<std::jthread> threads;
  for (std::size_t k = 0; k < jobs; ++k)
    threads.emplace_back([&] {
      for (std::size_t i = 0; (i = next++) < count;) work(i);
    });
}

std::vector<SurveySpec> specs_of(const SweepOptions& o) {
  std::vector<SurveySpec> specs;
  for (const std::string& family : o.families)
    for (const std::string& kind : o.classes)
      for (std::size_t i = 0; i < o.count; ++i) {
        SurveySpec spec;
        spec.family = support::family_named(family);
        spec.kind = support::class_named(kind);
        spec.rows = o.rows;
        // Where thresholds decide: effects near the noise, and effects well above it.
        spec.ratio = i % 2 == 0 ? 0.7 : 2;
        spec.seed = o.seed + 1000 * specs.size();
        specs.push_back(spec);
      }
  return specs;
}

void run(const SweepOptions& o) {
  std::vector<Subject> subjects;
  std::vector<Told> before;
  std::mutex lock;
  const std::vector<SurveySpec> specs = specs_of(o);
  in_parallel(specs.size(), o.jobs, [&](std::size_t i) {
    try {
      Subject subject;
      subject.survey = support::make_survey(specs[i]);
      subject.machine = parse_machine(subject.survey.model, "model.xml");
      subject.rows = parse_measurement(subject.survey.csv, "survey.csv", subject.machine);
      const Told plain = told(subject, {});
      const std::lock_guard<std::mutex> guard(lock);
      subjects.push_back(std::move(subject));
      before.push_back(plain);
    } catch (const std::runtime_error&) {  // the family cannot show it
    }
  });
  std::vector<Change> changes;
  for (const std::string& name : names_of(o.search))
    if (o.only.empty() || std::any_of(o.only.begin(), o.only.end(),
                                      [&](const std::string& part) { return name.rfind(part, 0) == 0; }))
      for (const double factor : {1 / o.by, o.by}) {
        Change change{.name = name, .factor = factor};
        changed(name, factor, &change.value);
        changes.push_back(change);
      }
  std::size_t good = 0;
  for (const Told& one : before) good += one.good ? 1 : 0;
  fmt::print("{} surveys of {} rows, seed {}, {} as asked; {} numbers\n\n", subjects.size(), o.rows, o.seed,
             good, changes.size() / 2);
  in_parallel(changes.size(), o.jobs, [&](std::size_t i) {
    Change& change = changes[i];
    const DiagnoseThresholds thresholds = changed(change.name, change.factor);
    for (std::size_t k = 0; k < subjects.size(); ++k) {
      const Told now = told(subjects[k], thresholds);
      const Told& was = before[k];
      change.verdicts += now.verdict != was.verdict ? 1 : 0;
      change.names += now.names != was.names ? 1 : 0;
      change.lost += was.good && !now.good ? 1 : 0;
      change.gained += !was.good && now.good ? 1 : 0;
      change.wrong += !was.wrong && now.wrong ? 1 : 0;
    }
    fmt::print(stderr, "\r{} {}          ", change.name, change.factor);
  });
  fmt::print(
      "| level | at | verdicts | ladders | right answers | new wrong names "
      "|\n|---|---|---|---|---|---|\n");
  std::vector<std::string> idle;
  for (std::size_t i = 0; i + 1 < changes.size(); i += 2) {
    for (const Change& change : {changes[i], changes[i + 1]})
      if (change.any())
        fmt::print("| `{}` | {:.4g} | {} | {} | {:+d} | {} |\n", change.name, change.value, change.verdicts,
                   change.names, static_cast<int>(change.gained) - static_cast<int>(change.lost),
                   change.wrong);
    if (!changes[i].any() && !changes[i + 1].any()) idle.push_back(changes[i].name);
  }
  fmt::print("\nNothing changed by {} of {}:\n", idle.size(), changes.size() / 2);
  for (const std::string& name : idle) fmt::print("`{}`\n", name);
}

}  // namespace
}  // namespace vernier::bench

int main(int argc, char** argv) {
  vernier::bench::SweepOptions o;
  CLI::App app("Halves and doubles each level of a diagnosis over surveys of known truth");
  app.add_option("--family", o.families, "machine families")->delimiter(',');
  app.add_option("--only", o.only, "levels whose names begin so")->delimiter(',');
  app.add_option("-n,--count", o.count, "surveys of each family and class");
  app.add_option("--rows", o.rows, "rows of a survey")->check(CLI::Range(20, 1000000));
  app.add_option("--seed", o.seed, "of the first survey");
  app.add_option("--class", o.classes, "single, two, outside, noise, confusable")->delimiter(',');
  app.add_option("-j,--jobs", o.jobs, "diagnoses at the same time")->check(CLI::Range(1, 64));
  app.add_option("--by", o.by, "factor instead of 2: by 100 what is left unchanged decides nothing at all")
      ->check(CLI::Range(1.01, 1e6));
  app.add_flag("--search", o.search, "the numbers of the search extent instead of the levels");
  CLI11_PARSE(app, argc, argv);
  vernier::bench::run(o);
  return 0;
}
