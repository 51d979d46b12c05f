// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "tools/diagnose/diagnosis.h"
#include "tools/fit/files/file_noise.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::commands {

/// Arguments of the commands that search for effects in a survey.
struct SurveyArguments {
  std::string machine, images;
  std::vector<std::string> measurements, columns;
};

/// Adds the arguments MACHINE, MEAS, --images and --column to a command.
void add_survey(CLI::App& command, SurveyArguments& arguments);

/// A survey that was read from its files. Columns with a stated role are inputs of the machine, and each file
/// has its own set-up (effects::complete_survey, with notes in machine.notes).
struct Survey {
  std::string text;
  model::Machine machine;
  model::Measurement rows;
};
/// `prepare`: a function that changes the machine each time after its file is read; may be empty. Throws
/// InputError if a file is not valid.
Survey read_survey(const SurveyArguments& arguments,
                   const std::function<model::Machine(model::Machine)>& prepare = {});

/// Estimates u of the readings without u if other readings have u (fit::estimate_file_noise), with a note in
/// machine.notes for each estimate.
std::vector<fit::FileNoise> estimate_noise(Survey& survey);

/// Estimates u of the readings without u again, with the machine of `text` (a machine with more effects).
/// `machine`: the machine of `rows`. Returns true if `rows` and `noise` have other values now.
bool estimate_noise_again(const std::string& text, const model::Machine& machine, model::Measurement& rows,
                          std::vector<fit::FileNoise>& noise);

/// Diagnoses, and again if the found effects change the estimates of u: an estimate from the residual of the
/// given model contains the errors that these effects explain. `rows` and `noise` have the last estimates
/// then.
diagnose::Diagnosis diagnose_and_estimate_noise(const std::string& text, const model::Machine& machine,
                                                model::Measurement& rows, std::vector<fit::FileNoise>& noise,
                                                const diagnose::DiagnoseOptions& options);

/// Adds sentences to an explanation.
void add_sentences(std::string& explanation, const std::vector<std::string>& sentences);

/// Sentences about the estimates of u, for an explanation.
std::vector<std::string> noise_sentences(const std::vector<fit::FileNoise>& noise);

/// Axes whose table has so few stations that a curve between them can be the error that has no cause.
struct StationAdvice {
  std::vector<std::string> sentences;
  bool has_call = false;  // true: a sentence has the call that adds stations
};
/// Returns what can be said about stations: an axis is named if a candidate of the axis fails because of its
/// stations, or if the points are much denser than the stations and measure all fitted columns of the table.
/// Empty if the verdict names causes.
StationAdvice station_advice(const diagnose::Diagnosis& diagnosis, const model::Machine& machine,
                             const model::Measurement& rows);

}  // namespace vernier::commands
