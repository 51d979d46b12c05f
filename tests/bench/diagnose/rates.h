// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/diagnose/answer.h"

namespace vernier::bench {

/// One survey and what was said about it.
struct Case {
  std::size_t number = 0;
  support::SurveySpec spec;
  std::string hidden;  // effect, axis, input and term of the key
  bool can_tell = false;
  Judgement judgement;
  double seconds = 0;
  std::optional<double> held_out;
  std::string trouble;  // of the survey or of the steps after the diagnosis
};

/// Counts of outcomes.
struct Tally {
  std::array<std::size_t, kOutcomes> count{};
  std::size_t total() const;
  std::size_t operator[](Outcome outcome) const { return count[static_cast<std::size_t>(outcome)]; }
};

/// Share in per cent with its 95 % interval (Wilson score), as "98.2 % (96.1 .. 99.2)".
std::string share_text(std::size_t part, std::size_t all);

/// The tables: per class and ratio, per effect, per family, per cell with a failure; then the failures with
/// the command that writes each survey.
void print_rates(const std::vector<Case>& cases, std::size_t most_failures);

/// Every case, for programs.
nlohmann::json cases_json(const std::vector<Case>& cases);

/// The command that writes the survey of a case again.
std::string again(const Case& one);

/// Is this outcome what the issue asks for, given the class of the survey?
bool is_good(const Case& one);
/// Was something named with confidence that is not there?
bool is_wrong_name(const Case& one);

}  // namespace vernier::bench
