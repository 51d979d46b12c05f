// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/commands/survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "tools/commands/command.h"
#include "tools/diagnose/between_stations.h"
#include "tools/effects/roles.h"
#include "tools/effects/survey/complete_survey.h"
#include "tools/lint/dense_points.h"
#include "tools/model/machine_reader.h"
#include "tools/model/rebind.h"
#include "tools/simulate/corrected.h"
#include "tools/text/files.h"

namespace vernier::commands {

void add_survey(CLI::App& command, SurveyArguments& arguments) {
  command.add_option("MACHINE", arguments.machine, "machine file (XML)")->type_name(kReads)->required();
  command.add_option("MEAS", arguments.measurements, "measurement files (CSV)")
      ->type_name(kReads)
      ->required();
  command.add_option("--images", arguments.images, simulate::kImagesHelp)->type_name(kReadsFolder);
  command
      .add_option("--column", arguments.columns,
                  "NAME=ROLE: meaning of a logged column, if its unit and name suggest another meaning: "
                  "temperature, load, "
                  "vibration, set-point, other, ignore; may be repeated")
      ->allow_extra_args(false)
      ->type_name("NAME=ROLE");
}

Survey read_survey(const SurveyArguments& arguments,
                   const std::function<model::Machine(model::Machine)>& prepare) {
  const model::ImageCorrection images = simulate::corrections_of_images(arguments.images);
  effects::CompletedSurvey complete = effects::complete_survey(
      text::read_file(arguments.machine), arguments.machine, arguments.measurements, images, prepare);
  Survey survey{std::move(complete.text), std::move(complete.machine), std::move(complete.rows)};
  if (!arguments.columns.empty()) {
    std::vector<effects::ColumnRole> roles;
    for (const std::string& statement : arguments.columns)
      roles.push_back(effects::parse_column_role(statement));
    survey.text = effects::with_declared_columns(survey.text, survey.machine, survey.rows, roles);
    survey.machine = model::parse_machine(survey.text, arguments.machine);
    if (prepare) survey.machine = prepare(std::move(survey.machine));
    survey.rows = model::read_measurement(arguments.measurements, survey.machine, images);
    effects::leave_out(survey.rows, roles);
  }
  survey.machine.notes.insert(survey.machine.notes.end(), complete.notes.begin(), complete.notes.end());
  return survey;
}

std::vector<fit::FileNoise> estimate_noise(Survey& survey) {
  std::vector<fit::FileNoise> list = fit::estimate_file_noise(survey.machine, survey.rows);
  for (const fit::FileNoise& noise : list) survey.machine.notes.push_back(noise.sentence());
  return list;
}

bool estimate_noise_again(const std::string& text, const model::Machine& machine, model::Measurement& rows,
                          std::vector<fit::FileNoise>& noise) {
  if (noise.empty()) return false;
  const model::Machine other = model::parse_machine(text, machine.file);
  model::Measurement bound = model::rebind(rows, machine, other);
  if (!fit::estimate_file_noise_again(other, bound, noise)) return false;
  rows.uncertainty = bound.uncertainty;
  rows.angle_uncertainty = bound.angle_uncertainty;
  return true;
}

diagnose::Diagnosis diagnose_and_estimate_noise(const std::string& text, const model::Machine& machine,
                                                model::Measurement& rows, std::vector<fit::FileNoise>& noise,
                                                const diagnose::DiagnoseOptions& options) {
  constexpr int kMostRepeats = 2;
  diagnose::Diagnosis diagnosis = diagnose::diagnose(text, machine, rows, options);
  for (int count = 0; count < kMostRepeats && diagnosis.ladder.size() > 1 &&
                      estimate_noise_again(diagnosis.machine_text, machine, rows, noise);
       ++count)
    diagnosis = diagnose::diagnose(text, machine, rows, options);
  return diagnosis;
}

void add_sentences(std::string& explanation, const std::vector<std::string>& sentences) {
  for (const std::string& sentence : sentences) explanation += " " + sentence;
}

std::vector<std::string> noise_sentences(const std::vector<fit::FileNoise>& noise) {
  std::vector<std::string> list;
  for (const fit::FileNoise& one : noise) list.push_back(one.sentence() + ".");
  return list;
}

StationAdvice station_advice(const diagnose::Diagnosis& diagnosis, const model::Machine& machine,
                             const model::Measurement& rows) {
  StationAdvice advice;
  if (diagnosis.verdict != diagnose::Verdict::kUnexplained) return advice;
  const std::vector<lint::DensePoints> dense = lint::dense_points(machine, rows);
  std::set<std::string> axes;
  for (const diagnose::CandidateFinding& one : diagnosis.candidates) {
    if (!one.axis) continue;
    const std::string& name = machine.axes[*one.axis].name;
    const auto found = std::find_if(dense.begin(), dense.end(),
                                    [&](const lint::DensePoints& points) { return points.axis == name; });
    const bool more = found != dense.end() && !found->one_column;
    const bool refused = one.why_not.starts_with(diagnose::kTestBetweenStations);
    if (!(refused || (more && one.score > 0)) || !axes.insert(name).second) continue;
    std::string sentence =
        fmt::format("A curve between two stations of the table of {} can be this error", name);
    if (more)
      sentence += fmt::format(
          ": add stations to the table (vernier set MACHINE --stations {}={:.4g} -o NEW), fit and diagnose "
          "again, and keep them unless the rms of the check rows is larger by more than a tenth with them",
          name, found->step);
    else if (found == dense.end())
      sentence += fmt::format(
          ", and the measurements are not dense enough for more stations: measure {} alone at more positions",
          name);
    advice.sentences.push_back(sentence + ".");
    advice.has_call = advice.has_call || more;
  }
  return advice;
}

}  // namespace vernier::commands
