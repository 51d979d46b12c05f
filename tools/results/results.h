// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/fit/fit.h"
#include "tools/fit/noise/noise.h"

namespace vernier::results {

/// Return the JSON keys that the results of `fit` and `compare` have in common (FORMATS section 3).
nlohmann::ordered_json fit_json(const fit::FitResult& result, const model::Measurement& measurement);
nlohmann::ordered_json compare_json(const model::Machine& machine, const model::Measurement& measurement,
                                    const Eigen::VectorXd& residual);

/// Returns the groups of successive rows of one role within each run, in the order of the file: {run, role,
/// first_line, last_line, n_obs, rms_um}. The groups show in which part of a run a model is valid (an
/// overshoot arc, a warm-up, a late row).
nlohmann::ordered_json stretches_json(const model::Measurement& measurement, const Eigen::VectorXd& residual);

/// domains_json returns the rows inside and outside the domains of validity of learned terms: {domain,
/// quantity, low, high (of the training data; null while open), least, most (of the rows), rows_outside,
/// rows_without_effect}. print_domains prints the same data for people, one line for each domain, if rows are
/// outside.
nlohmann::ordered_json domains_json(const model::Machine& machine, const model::Measurement& measurement);
void print_domains(std::FILE* out, const nlohmann::ordered_json& domains);

/// Returns a noise model as JSON: {own_um, pose_um, run_um, drift_um, drift_time, drift_time_unit, support,
/// sentence}. The noise components are in um, or in arcsec if no length was read.
nlohmann::ordered_json noise_json(const fit::NoiseModel& noise, const fit::NoiseUnit& unit);

/// An expression of a chain, and whether it moves the workpiece.
struct ChainTerm {
  model::ExprPtr expression;
  bool workpiece = false;
};

/// Returns what a coefficient of an approach direction means, for a parameter of a term such as
/// "backlash_X*dirX": "coefficient of dirX; reversal value B = -12.15 um". The reversal value of ISO 230-2 is
/// the difference of both approach directions of the tool point relative to the workpiece: twice the
/// coefficient, with the opposite sign for a length that moves the workpiece. `terms`: the term, or the
/// expressions of the chain. `value`: in `unit` (mm or deg). Empty for every other parameter.
std::string reversal_note(const std::vector<ChainTerm>& terms, const std::string& name, double value,
                          const std::string& unit);
/// Returns all expressions of the chain of a machine, for reversal_note().
std::vector<ChainTerm> chain_expressions(const model::Machine& machine);

/// Returns a number as text for users: four significant digits, "-" if there is no value.
std::string number_or_dash(const std::optional<double>& value, const char* unit);
/// Returns an error as text for people: the error of the lengths in um, or in urad if only angles were
/// measured; "-" if there is no value.
std::string error_or_dash(const std::optional<double>& um, const std::optional<double>& urad);

}  // namespace vernier::results
