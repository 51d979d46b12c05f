// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/diagnose/rates.h"

namespace CLI {
class App;
}

namespace vernier::bench {

/// How the surveys of a table are made and judged.
struct CaseOptions {
  std::string vernier;        // the program to judge
  std::string keep{};         // a folder for every survey, which stay; empty: none stays
  std::string scratch{};      // where they stand in between; empty: the system's place
  std::size_t jobs = 2;       // at the same time
  bool any = false;           // also surveys whose data cannot tell
  bool only_written = false;  // nothing is run
};

/// The options that every table has: --vernier, --keep, --scratch, --jobs.
void declare(CLI::App& app, CaseOptions& options);

/// Seed of a survey of a table: of its own, far from that of the next one, which may be tried in turn.
std::uint64_t seed_of_case(std::uint64_t table, std::size_t number);

/// Makes the survey of every case (of class single the first of up to 40 seeds whose data can tell), writes
/// it, runs `vernier diagnose` on it and judges the answer; `also` is told the case, its survey, its folder
/// and the answer. Troubles stand in the case. Progress goes to standard error.
using AlsoDone = std::function<void(Case&, const support::HiddenSurvey&, const std::string& folder,
                                    const std::string& answer)>;
void run_cases(std::vector<Case>& cases, const CaseOptions& options, const AlsoDone& also = {});

/// Takes out the cases without a survey, which are no verdict on the diagnosis, and returns them.
std::vector<Case> without_survey(std::vector<Case>& cases);
/// Says which those are.
void print_missing(const std::vector<Case>& missing);

}  // namespace vernier::bench
