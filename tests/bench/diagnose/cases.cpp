// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/diagnose/cases.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <filesystem>
#include <mutex>
#include <thread>

#include "tests/bench/diagnose/process.h"
#include "tests/support/hidden_survey_key.h"
#include "tools/text/files.h"

namespace vernier::bench {

using namespace vernier::support;
using namespace vernier::text;
namespace {

constexpr int kSeedsTried = 40;

std::optional<HiddenSurvey> survey_of(Case& one, bool any) {
  const bool must_tell =
      !any && one.spec.kind != SurveyClass::kNoise && one.spec.kind != SurveyClass::kConfusable;
  for (int k = 0; k < (must_tell ? kSeedsTried : 1); ++k, ++one.spec.seed) {
    HiddenSurvey survey = make_survey(one.spec);
    if (must_tell && !survey.can_tell) continue;
    one.can_tell = survey.can_tell;
    for (const HiddenEffect& e : survey.effects)
      one.hidden += fmt::format("{}{} axis={} input={} {}", one.hidden.empty() ? "" : " + ", e.cause.effect,
                                e.cause.axis, e.cause.input, e.term);
    return survey;
  }
  one.trouble = fmt::format("no survey whose data can tell in {} seeds", kSeedsTried);
  return {};
}

void write(const HiddenSurvey& survey, const std::string& folder) {
  std::filesystem::create_directories(folder);
  write_file(folder + "/model.xml", survey.model);
  write_file(folder + "/survey.csv", survey.csv);
  write_file(folder + "/key.json", key_of(survey));
  write_file(folder + "/truth.xml", survey.truth);
}

void diagnose(Case& one, const HiddenSurvey& survey, const CaseOptions& o, const std::string& folder,
              const AlsoDone& also) {
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
  if (also) also(one, survey, folder, run.output);
}

void treat(Case& one, const CaseOptions& o, const std::string& scratch, const AlsoDone& also) {
  const std::string folder = fmt::format("{}/case{}", o.keep.empty() ? scratch : o.keep, one.number);
  try {
    const std::optional<HiddenSurvey> survey = survey_of(one, o.any);
    if (!survey) return;
    write(*survey, folder);
    if (!o.only_written) diagnose(one, *survey, o, folder, also);
  } catch (const std::exception& wrong) {
    one.trouble = wrong.what();
  }
  if (o.keep.empty()) std::filesystem::remove_all(folder);
}

}  // namespace

void declare(CLI::App& app, CaseOptions& o) {
  app.add_option("--keep", o.keep, "write the surveys here, a folder each, and keep them");
  app.add_option("-j,--jobs", o.jobs, "diagnoses at the same time")->check(CLI::Range(1, 64));
  app.add_option("--vernier", o.vernier, "program to judge");
  app.add_option("--scratch", o.scratch, "folder for files in between");
}

std::uint64_t seed_of_case(std::uint64_t table, std::size_t number) {
  return (table * 1000003 + number) * 64;
}

void run_cases(std::vector<Case>& cases, const CaseOptions& o, const AlsoDone& also) {
  if (!o.only_written && !std::filesystem::exists(o.vernier))
    throw std::runtime_error(o.vernier + ": no such program");
  const std::string base = o.scratch.empty() ? std::filesystem::temp_directory_path().string() : o.scratch;
  std::string scratch = base + "/diagnose_rates_XXXXXX";
  if (mkdtemp(scratch.data()) == nullptr) throw std::runtime_error(scratch + ": cannot be made");
  std::atomic<std::size_t> next = 0, done = 0;
  std::mutex print;
  const auto work = [&] {
    for (std::size_t i = 0; (i = next++) < cases.size();) {
      treat(cases[i], o, scratch, also);
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
  std::filesystem::remove_all(scratch);
}

std::vector<Case> without_survey(std::vector<Case>& cases) {
  std::vector<Case> missing;
  std::erase_if(cases, [&](const Case& one) {
    const bool none = one.hidden.empty() && one.spec.kind != SurveyClass::kNoise;
    if (none) missing.push_back(one);
    return none;
  });
  return missing;
}

void print_missing(const std::vector<Case>& missing) {
  for (const Case& one : missing)
    fmt::print("  {} {} ratio {:g}: {}\n", family_name(one.spec.family), one.spec.effect, one.spec.ratio,
               one.trouble);
}

}  // namespace vernier::bench
